import { formatSi } from "../../ui/format";
import { ratioWords } from "./change-words";
import type { PlotTrace } from "./paint-scope";
import type { Figures } from "./use-figures";

const DIGITS = 3;
const NOISE = 0.05;

/** The figures of a trace before and after a change, in words. */
export interface Compared {
  trace: PlotTrace;
  before: string;
  after: string;
  ratio: string;
  isSettled: boolean;
  /** How far the ratio is from 1: its natural logarithm without its sign, in steps that noise seldom passes. */
  strength: number;
}

/** The figures of the traces of a scope, the largest change first. */
export function comparedOf(traces: readonly PlotTrace[], { before, after, settled }: Figures): Compared[] {
  const all = traces.map((trace, i): Compared => {
    const now = after?.[i] ?? Number.NaN;
    const strength = Math.round(Math.abs(Math.log(now / before[i])) / NOISE) * NOISE;
    return {
      trace,
      before: formatSi(before[i], trace.unit, DIGITS),
      after: formatSi(now, trace.unit, DIGITS),
      ratio: ratioWords(before[i], now),
      isSettled: settled?.[i] ?? false,
      strength: Number.isFinite(strength) ? strength : 0,
    };
  });
  return all.sort((a, b) => b.strength - a.strength);
}
