import { api } from "../../api/api";
import type { Claim, ClaimList } from "../../api/types";
import { marksNow } from "../../bench/marks";
import { marksOver } from "../../bench/printed";
import { reachMarks } from "../../picture/printed-marks";
import { useBench } from "../../stream/bench-store";
import { traceColour, traceStyle } from "../../ui/trace-style";
import { unitScale } from "../../ui/unit-scale";
import { extent } from "../phase/phase-range";
import { roundRange } from "../scope/axis-range";
import type { ScopeShown } from "../scope/paint-scope";
import { partnersOf, signalsOf } from "./claim-signals";

const COLUMNS = 1200;
const MOST_UNITS = 2;

/** The traces of a claim over the run that is measured, as a scope has them. */
export async function slideTraces(claim: Claim, { tick, bench_id }: ClaimList): Promise<ScopeShown | undefined> {
  const { bench } = useBench.getState();
  if (!bench || tick < 2) return undefined;
  const known = bench.signals.map(({ name }) => name);
  const marked = [...new Set(claim.marks.flatMap(({ signal, problem }) => (problem ? [] : [signal])))];
  const names = marked.length > 0 ? [...marked, ...partnersOf(marked)] : signalsOf(claim.metric, known);
  const span = { start: bench.first_tick, end: tick };
  const found = await api.trace(bench_id, names, span.start, span.end, Math.min(COLUMNS, tick));
  const hypotheses = Object.values(bench.diagnosers)[0]?.names ?? [];
  const traces = names.map((name) => {
    const style = traceStyle(name, known, hypotheses);
    const unit = bench.signals.find((signal) => signal.name === name)?.unit ?? "";
    return { name, unit, ...style, colour: traceColour(style, "light") };
  });
  const envelopes = names.map((name) => ({
    low: Float32Array.from(found.signals[name].min, (value) => value ?? Number.NaN),
    high: Float32Array.from(found.signals[name].max, (value) => value ?? Number.NaN),
  }));
  const units = [...new Set(traces.map(({ unit }) => unit))].slice(0, MOST_UNITS);
  const printed = marksOver(claim.marks, names);
  const ranges = units.map((unit) => {
    const own = envelopes.filter((_, i) => traces[i].unit === unit);
    const ends = own.flatMap(({ low, high }) => [...(extent(low) ?? []), ...(extent(high) ?? [])]);
    return roundRange(...reachMarks([Math.min(...ends), Math.max(...ends)], printed, unit, span));
  });
  const columns = envelopes[0].low.length;
  const width = (span.end - span.start) / columns;
  return {
    traces,
    envelopes,
    bands: [],
    times: Float64Array.from({ length: columns }, (_, c) => (span.start + (c + 0.5) * width) * bench.dt_ms),
    units,
    scales: units.map((unit, i) => unitScale(unit, Math.max(Math.abs(ranges[i].min), Math.abs(ranges[i].max)))),
    ranges,
    span,
    origin: 0,
    isTriggered: false,
    isLog: false,
    dtMs: bench.dt_ms,
    marks: marksNow(),
    printed,
  };
}
