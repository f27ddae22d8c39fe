import { useCallback, useEffect, useRef, useState } from "react";
import { jump } from "../../ui/jump";
import type { TimeWindow } from "./time-window";

const LIVE: TimeWindow = { kind: "live" };
const REFETCH_MS = 60;

/**
 * Where a time panel looks. `span` moves at once with the hand and holds ticks while the panel is detached;
 * `view` follows a moment later and asks the server for the detail.
 */
export function useTimeView(windowMs: number, dtMs: number | undefined, onMove: (start: number, end: number) => void) {
  const span = useRef<{ start: number; end: number } | undefined>(undefined);
  const refetch = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  const move = useRef(onMove);
  move.current = onMove;
  const [view, setView] = useState<TimeWindow>(LIVE);

  const goLive = useCallback(() => {
    clearTimeout(refetch.current);
    span.current = undefined;
    setView(LIVE);
  }, []);

  const look = useCallback((start: number, end: number) => {
    span.current = { start, end };
    move.current(start, end);
    clearTimeout(refetch.current);
    refetch.current = setTimeout(() => setView({ kind: "past", start, end }), REFETCH_MS);
  }, []);

  useEffect(
    () =>
      jump.listen((target) => {
        if (target === "live") return goLive();
        const width = windowMs / (dtMs ?? 1);
        look(target.tick - width * 0.25, target.tick + width * 0.75);
      }),
    [goLive, look, windowMs, dtMs],
  );
  useEffect(() => () => clearTimeout(refetch.current), []);
  return { view, span, look, goLive };
}
