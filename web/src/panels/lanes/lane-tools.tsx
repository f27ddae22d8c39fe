import { NativeSelect } from "@mantine/core";
import scopeStyles from "../scope/scope.module.css";
import type { LaneTime } from "./use-lane-time";

export const WINDOWS_MS = [2, 4, 10, 20, 50, 100, 200, 500];

/** How much time the lanes show, and the way back to now. */
export function LaneTools({ time, onWindow }: { time: LaneTime; onWindow(ms: number): void }) {
  return (
    <>
      <NativeSelect
        size="xs"
        w={84}
        aria-label="Time window"
        value={String(time.windowMs)}
        data={WINDOWS_MS.map((ms) => ({ value: String(ms), label: `${ms}\u00a0ms` }))}
        onChange={(e) => onWindow(Number(e.currentTarget.value))}
      />
      <button
        type="button"
        className={scopeStyles.live}
        data-past={time.view.kind === "past"}
        aria-pressed={time.view.kind === "live"}
        onClick={time.goLive}
      >
        LIVE
      </button>
    </>
  );
}
