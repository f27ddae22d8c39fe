import { useMemo } from "react";
import { useBench } from "../../stream/bench-store";
import type { Subscription } from "../../stream/wire";

const MOST_COLUMNS = 4096;

/** The subscription to every tick of some signals in a window up to now. */
export function useTicks(signals: string[], windowMs: number): Subscription | undefined {
  const dtMs = useBench((s) => s.bench?.dt_ms);
  return useMemo(() => {
    if (!dtMs) return undefined;
    const width = Math.max(2, Math.min(MOST_COLUMNS, Math.round(windowMs / dtMs)));
    return { mode: "roll", signals, window_ms: windowMs, width };
  }, [signals, windowMs, dtMs]);
}
