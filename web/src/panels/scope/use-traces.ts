import { useMemo } from "react";
import type { Behind } from "../../bench/behind";
import { useBench } from "../../stream/bench-store";
import { faded } from "../../ui/palette";
import { traceColour, traceStyle } from "../../ui/trace-style";
import { useScheme } from "../../ui/use-canvas";
import { DIFFERENCE, type PlotTrace } from "./paint-scope";
import type { Drives } from "./use-on-bench";

const NONE: Drives = {};

/** The traces of some signals, as far as the bench has them, in the colours they have everywhere. */
export function useTraces(names: string[], drives: Drives = NONE): PlotTrace[] {
  const scheme = useScheme();
  const signals = useBench((s) => s.bench?.signals);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  return useMemo(() => {
    const all = (signals ?? []).map((s) => s.name);
    const hypotheses = Object.values(diagnosers ?? {})[0]?.names ?? [];
    return names.flatMap((name) => {
      const signal = signals?.find((s) => s.name === name);
      if (!signal) return [];
      const style = traceStyle(name, all, hypotheses);
      const { slot, dash } = style;
      return [{ name, unit: signal.unit, slot, dash, colour: traceColour(style, scheme), drives: drives[name] }];
    });
  }, [names, signals, diagnosers, scheme, drives]);
}

/** The same traces of other benches, faded, in the order in which the server sends them; then the differences from the first. */
export function useTracesBehind(traces: PlotTrace[], behind: readonly Behind[], difference: boolean): PlotTrace[] {
  const scheme = useScheme();
  return useMemo(() => {
    const others = behind.flatMap(({ words }) =>
      traces.map((trace) => ({ ...trace, colour: faded(trace.colour, scheme), behind: words })),
    );
    const differences = traces.map(({ name, unit, ...style }) => ({
      ...style,
      name: `difference of ${name}`,
      unit: `${DIFFERENCE}${unit}`,
      dash: 2,
    }));
    return difference && behind.length > 0 ? [...others, ...differences] : others;
  }, [traces, behind, difference, scheme]);
}
