import { useEffect, useMemo, useRef } from "react";
import { type Span, type TimeWindow, useTimeView } from "../scope/use-time-view";

/** One window into time for any number of canvases, which are called when the hand moves it. */
export interface LaneTime {
  windowMs: number;
  view: TimeWindow;
  /** Ticks held while detached from live; undefined while live. */
  held(): Span | undefined;
  /** Ticks shown while live, whatever the newest of them; undefined where the newest is at the end. */
  whole: Span | undefined;
  look(start: number, end: number): void;
  goLive(): void;
  listen(moved: () => void): () => void;
}

export function useLaneTime(windowMs: number, dtMs: number | undefined, whole?: Span): LaneTime {
  const listeners = useRef(new Set<() => void>());
  const { view, span, look, goLive } = useTimeView(windowMs, dtMs, () => {
    for (const moved of listeners.current) moved();
  });
  useEffect(() => {
    for (const moved of listeners.current) moved();
  });
  const { start, end } = whole ?? {};
  return useMemo(
    () => ({
      windowMs,
      view,
      held: () => span.current,
      whole: start === undefined || end === undefined ? undefined : { start, end },
      look,
      goLive,
      listen: (moved) => {
        listeners.current.add(moved);
        return () => {
          listeners.current.delete(moved);
        };
      },
    }),
    [windowMs, view, start, end, span, look, goLive],
  );
}
