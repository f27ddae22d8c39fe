import { formatSi } from "../../ui/format";
import { ratioWords } from "./change-words";
import type { PlotTrace } from "./paint-scope";
import type { Figures } from "./use-figures";
import { drove } from "./while-driving";

const DIGITS = 3;
/** Differences between strengths that noise seldom passes. */
const STEP = 0.05;
/** A noise below this share of the RMS is not to be seen. */
const NOTABLE = 0.01;
/** The logarithm of the ratio of an RMS that says enough: twice as large, or half. */
const CHANGED = Math.LN2;
/** The strength of a change from or to nothing. */
const MOST = 5;
/** A mean that moves by more than this share of the RMS before is a shift. */
const SHIFTED = 0.1;

/** The figures of a trace before and after a change, in words. */
export interface Compared {
  trace: PlotTrace;
  measure: "RMS" | "noise";
  before: string;
  after: string;
  /** How the trace has changed: larger or smaller, or shifted. */
  ratio: string;
  isSettled: boolean;
  /** How far the ratio is from 1: its natural logarithm without its sign, in steps. */
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
  { before, after, settled, shift, noise }: Figures,
  tick: number,
): Compared[] {
  const all = traces.flatMap((trace, i): Compared[] => {
    if (trace.drives && !drove(trace.drives, tick)) return [];
    const was = before[earlier(traces, trace, tick)] ?? Number.NaN;
    const now = after?.[i] ?? Number.NaN;
    const moved = trace.drives ? 0 : (shift?.[i] ?? 0);
    const noises = trace.drives ? undefined : noise?.[i];
    // a bias hardly changes the RMS of a sine; a bias below the noise is not to be seen
    const isShifted = Math.abs(moved) > Math.max(SHIFTED * was, Math.abs(now - was), ...(noises ?? []));
    const change = isShifted ? moved / was : Math.log(now / was);
    const said = (from: number, to: number, by: number) => ({
      trace,
      before: formatSi(from, trace.unit, DIGITS),
      after: formatSi(to, trace.unit, DIGITS),
      ratio: ratioWords(from, to),
      isSettled: settled?.[i] ?? false,
      strength: Number.isFinite(by) ? Math.round(Math.abs(by) / STEP) * STEP : 0,
    });
    const whole: Compared = { ...said(was, now, change), measure: "RMS" };
    if (isShifted) whole.ratio = `shifted by ${moved > 0 ? "+" : ""}${formatSi(moved, trace.unit, DIGITS)}`;
    if (!noises) return [whole];
    // the RMS of a sine hides its noise, but not where the sine itself came or went
    if (Math.abs(change) > CHANGED) return [whole];
    const [quiet, loud] = noises;
    const grown = Math.min(MOST, Math.abs(Math.log(loud / quiet)));
    const hiss: Compared = { ...said(quiet, loud, grown), measure: "noise" };
    if (quiet === 0) hiss.ratio = "appeared";
    if (loud === 0) hiss.ratio = "gone";
    const counts = Math.max(quiet, loud) > NOTABLE * Math.max(was, now);
    return counts && grown > Math.abs(change) ? [whole, hiss] : [whole];
  });
  return all.sort((a, b) => b.strength - a.strength);
}
