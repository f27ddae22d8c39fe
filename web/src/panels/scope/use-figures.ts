import { useMemo, useState } from "react";
import type { Change } from "../../bench/change";
import { useBench } from "../../stream/bench-store";
import type { PanelFrame } from "../../stream/panel-frame";
import { useFeed } from "../../stream/use-feed";
import type { Subscription } from "../../stream/wire";
import { differ, type Noise, noiseOf } from "./noise";
import { hasSettled, lookAt, mean, rms, windowTicks } from "./whole-periods";

/** The root mean squares of the signals of a scope around a change. */
export interface Figures {
  before: number[];
  /** Over the newest whole periods; nothing until one has passed. */
  after?: number[];
  settled?: boolean[];
  /** How far the mean of each signal has moved since the change. */
  shift?: number[];
  /** The noise of each signal before and after the change, where it is surely another. */
  noise?: ([before: number, after: number] | undefined)[];
}

/** The figures of the signals around a change, and their means and noises before it. */
interface Known {
  of: Change;
  signals: string[];
  figures: Figures;
  means: number[];
  noises: Noise[];
}

/** Every sample of whole periods: before the change first, then the newest since. */
export function useFigures(signals: string[], change: Change | undefined): Figures | undefined {
  const period = useBench((s) => s.bench?.drive_period_ticks);
  const look = useBench((s) => (change && s.bench ? lookAt(s.bench.tick - change.since, period) : 0));
  const [known, setKnown] = useState<Known | undefined>(undefined);
  const found = known && known.of === change && known.signals === signals ? known.figures : undefined;
  const hasBefore = found !== undefined;

  const wanted = useMemo((): Subscription | undefined => {
    if (!change || signals.length === 0) return undefined;
    const frozen = (start_tick: number, end_tick: number): Subscription | undefined =>
      end_tick > start_tick
        ? { mode: "frozen", signals, start_tick, end_tick, width: end_tick - start_tick }
        : undefined;
    if (!hasBefore) return frozen(change.tick - windowTicks(period, change.tick), change.tick);
    const ticks = windowTicks(period, look);
    const isWhole = look >= 2 * ticks && ticks === windowTicks(period, Number.MAX_SAFE_INTEGER);
    const end = change.since + look;
    return frozen(end - (isWhole ? 2 : 1) * ticks, end);
  }, [change, signals, period, look, hasBefore]);

  useFeed(wanted, (frame) => {
    if (!change) return;
    if (frame.endTick === change.tick) {
      const before = signals.map((_, i) => rms(frame, i));
      const means = signals.map((_, i) => mean(frame, i));
      const noises = signals.map((_, i) => noiseOf(frame, i, period));
      return setKnown({ of: change, signals, figures: { before }, means, noises });
    }
    if (known && found && frame.startTick >= change.since)
      setKnown({ ...known, figures: newest(frame, known, period) });
  });
  return found;
}

/** The figures of the newest window, and whether the window before agrees. */
function newest(frame: PanelFrame, known: Known, period: number | null | undefined): Figures {
  const { figures, means, noises } = known;
  const { before } = figures;
  const ticks = windowTicks(period, frame.columns);
  const all = Array.from({ length: frame.signals }, (_, i) => i);
  const after = all.map((i) => rms(frame, i, frame.columns - ticks));
  const hasTwo = frame.columns >= 2 * ticks;
  const settled = all.map((i) => hasTwo && hasSettled(before[i], rms(frame, i, 0, ticks), after[i]));
  const shift = all.map((i) => mean(frame, i, frame.columns - ticks) - means[i]);
  const noise = noises.map((was, i): [number, number] | undefined => {
    if (!settled[i]) return undefined;
    const now = noiseOf(frame, i, period, frame.columns - ticks);
    return differ(was, now) && !differ(noiseOf(frame, i, period, 0, ticks), now) ? [was.rms, now.rms] : undefined;
  });
  return { before, after, settled, shift, noise };
}
