import { useMemo } from "react";
import { useBench } from "../../stream/bench-store";
import { traceColour, traceStyle } from "../../ui/trace-style";
import { useScheme } from "../../ui/use-canvas";
import type { PlotTrace } from "./paint-scope";

/** The traces of some signals, as far as the bench has them, in the colours they have everywhere. */
export function useTraces(names: string[]): PlotTrace[] {
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
      return [{ name, unit: signal.unit, slot: style.slot, colour: traceColour(style, scheme), dash: style.dash }];
    });
  }, [names, signals, diagnosers, scheme]);
}
