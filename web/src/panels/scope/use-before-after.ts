import { useMemo, useRef } from "react";
import { useChange } from "../../bench/change";
import { useBench } from "../../stream/bench-store";
import type { PanelFrame } from "../../stream/panel-frame";
import { useFeed } from "../../stream/use-feed";
import type { Subscription } from "../../stream/wire";
import { faded } from "../../ui/palette";
import { useScheme } from "../../ui/use-canvas";
import type { Ghost } from "./ghost";
import { BEFORE, type PlotTrace } from "./paint-scope";
import { useFigures } from "./use-figures";
import { mostColumns } from "./use-time-view";

const NONE: PlotTrace[] = [];

/** The last change as a scope compares it: its ghost traces, and the figures before and after. */
export function useBeforeAfter(traces: PlotTrace[], windowMs: number, redraw: () => void) {
  const scheme = useScheme();
  const change = useChange((s) => s.change);
  const isHidden = useBench((s) => s.blind);
  const dtMs = useBench((s) => s.bench?.dt_ms ?? 1);
  const period = useBench((s) => s.bench?.drive_period_ticks);
  const compared = isHidden ? undefined : change;
  const signals = useMemo(() => traces.map(({ name }) => name), [traces]);
  const figures = useFigures(signals, compared);

  const kept = useMemo((): Subscription | undefined => {
    if (!compared || signals.length === 0) return undefined;
    const ticks = Math.ceil(windowMs / dtMs + (period ?? 0));
    const end_tick = compared.tick;
    const width = Math.min(ticks, mostColumns(signals.length));
    return { mode: "frozen", signals, start_tick: end_tick - ticks, end_tick, width };
  }, [compared, signals, windowMs, dtMs, period]);
  const frame = useRef<PanelFrame | undefined>(undefined);
  useFeed(kept, (came) => {
    frame.current = came;
    redraw();
  });

  const ghost = useRef<() => Ghost | undefined>(() => undefined);
  ghost.current = () =>
    compared && frame.current?.endTick === compared.tick
      ? { frame: frame.current, since: compared.since, period }
      : undefined;
  const ghosts = useMemo(
    () =>
      compared ? traces.map((trace) => ({ ...trace, colour: faded(trace.colour, scheme), behind: BEFORE })) : NONE,
    [compared, traces, scheme],
  );
  return { change, isHidden, figures, ghosts, ghost };
}
