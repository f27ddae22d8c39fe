import { NativeSelect } from "@mantine/core";
import { PictureMenu, type TakePicture } from "../../picture/picture-menu";
import { TIME_WINDOWS_MS, windowItems } from "../../ui/time-axis";
import { LiveButton } from "../scope/live-button";
import type { LaneTime } from "./use-lane-time";

interface LaneToolsProps {
  time: LaneTime;
  onWindow(ms: number): void;
  take: TakePicture;
}

/** The window of the lanes, their picture as a file, and the way back to now. */
export function LaneTools({ time, onWindow, take }: LaneToolsProps) {
  return (
    <>
      <NativeSelect
        w={96}
        aria-label="Time window"
        value={String(time.windowMs)}
        data={windowItems(TIME_WINDOWS_MS.lanes, time.windowMs)}
        onChange={(e) => onWindow(Number(e.currentTarget.value))}
      />
      <PictureMenu take={take} />
      <LiveButton past={time.view.kind === "past"} onLive={time.goLive} />
    </>
  );
}
