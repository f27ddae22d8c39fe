import { formatSi } from "../../ui/format";
import { ratioWords } from "./change-words";
import type { PlotTrace } from "./paint-scope";
import type { Figures } from "./use-figures";
import { drove } from "./while-driving";

const DIGITS = 3;
const NOISE = 0.05;
/** A mean that moves by more than this share of the RMS before is a shift. */
const SHIFTED = 0.1;

/** The figures of a trace before and after a change, in words. */
export interface Compared {
  trace: PlotTrace;
  before: string;
  after: string;
  /** How the trace has changed: larger or smaller, or shifted. */
  ratio: string;
  isSettled: boolean;
  /** How far the ratio is from 1: its natural logarithm without its sign, in steps that noise seldom passes. */
  strength: number;
}

const quantity = ({ name }: PlotTrace): string => name.slice(name.indexOf(".") + 1);

/** The trace to compare a trace with, before a change: itself, or the trace of the controller that drove then. */
const earlier = (traces: readonly PlotTrace[], trace: PlotTrace, tick: number): number =>
  trace.drives
    ? traces.findIndex((one) => one.drives && quantity(one) === quantity(trace) && drove(one.drives, tick - 1))
    : traces.indexOf(trace);

/** The figures of the traces of a scope, the largest change first. */
export function comparedOf(
  traces: readonly PlotTrace[],
  { before, after, settled, shift }: Figures,
  tick: number,
): Compared[] {
  const all = traces.flatMap((trace, i): Compared[] => {
    if (trace.drives && !drove(trace.drives, tick)) return [];
    const was = before[earlier(traces, trace, tick)] ?? Number.NaN;
    const now = after?.[i] ?? Number.NaN;
    const moved = trace.drives ? 0 : (shift?.[i] ?? 0);
    // a bias hardly changes the RMS of a sine
    const isShifted = Math.abs(moved) > Math.max(SHIFTED * was, Math.abs(now - was));
    const change = isShifted ? moved / was : Math.log(now / was);
    const strength = Math.round(Math.abs(change) / NOISE) * NOISE;
    return [
      {
        trace,
        before: formatSi(was, trace.unit, DIGITS),
        after: formatSi(now, trace.unit, DIGITS),
        ratio: isShifted
          ? `shifted by ${moved > 0 ? "+" : ""}${formatSi(moved, trace.unit, DIGITS)}`
          : ratioWords(was, now),
        isSettled: settled?.[i] ?? false,
        strength: Number.isFinite(strength) ? strength : 0,
      },
    ];
  });
  return all.sort((a, b) => b.strength - a.strength);
}
