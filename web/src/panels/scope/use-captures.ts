import { useCallback, useEffect, useRef, useState } from "react";
import type { ScopeConfig } from "../../stream/scope-config";
import type { CaptureList, CaptureMark } from "../../stream/wire";

/** The capture `by` captures further on, within the list; from live it is the newest. */
export function captureAt(
  captures: readonly CaptureMark[],
  standing: CaptureMark | undefined,
  by: number,
): CaptureMark | undefined {
  if (captures.length === 0) return undefined;
  const last = captures.length - 1;
  if (!standing || by === Number.POSITIVE_INFINITY) return captures[last];
  // a capture that is no longer kept was before the next later one
  const behind = captures.findIndex(({ tick }) => tick >= standing.tick);
  const at = behind < 0 ? last + 1 : behind;
  const isKept = captures[at]?.tick === standing.tick;
  const wanted = at + by + (by > 0 && !isKept ? -1 : 0);
  return captures[Math.min(last, Math.max(0, wanted))];
}

/** The captures of a triggered scope, as the server tells them, and how to go through them. */
export function useCaptures(
  config: ScopeConfig,
  standing: CaptureMark | undefined,
  stand: (on: CaptureMark) => void,
  goLive: () => void,
) {
  const [list, setList] = useState<CaptureList | undefined>(undefined);
  const { sweep: _, ...trigger } = config.trigger;
  const what = JSON.stringify([config.mode, config.windowMs, config.signals, trigger]);
  const before = useRef(what);
  const isStanding = standing !== undefined;
  useEffect(() => {
    if (before.current === what) return;
    before.current = what;
    setList(undefined);
    if (isStanding) goLive(); // of another trigger
  }, [what, isStanding, goLive]);
  const captures = config.mode === "triggered" ? list : undefined;
  const browse = useCallback(
    (by: number) => {
      const next = captureAt(captures?.captures ?? [], standing, by);
      if (next && next.tick !== standing?.tick) stand(next);
    },
    [captures, standing, stand],
  );
  return { captures, hear: setList, browse };
}
