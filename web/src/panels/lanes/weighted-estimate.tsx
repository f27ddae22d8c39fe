import { useMemo } from "react";
import { useBench } from "../../stream/bench-store";
import { Figure } from "../../ui/figure";
import { formatNumber } from "../../ui/format";
import { useLiveValues } from "../schematic/use-live-values";

/** Signals of the weighted state, by their last word; a bank without states has none. */
export const STATE = ["displacement", "displacement_std", "velocity", "velocity_std"] as const;
/** Weighted parameters over nominal. */
export const PARTS = ["mass", "stiffness", "damping"] as const;

/** The diagnosers among these with signals of a weighted estimate; while a fault is hidden none has. */
export function useWeighted(ids: readonly string[]) {
  const signals = useBench((s) => s.bench?.signals);
  return useMemo(() => {
    const known = new Set(signals?.map(({ name }) => name));
    const names = ids.flatMap((id) => [...STATE, ...PARTS].map((port) => `${id}.weighted.${port}`));
    const shown = Object.fromEntries(names.filter((name) => known.has(name)).map((name) => [name, name]));
    return { shown, has: (id: string, port: string) => `${id}.weighted.${port}` in shown };
  }, [signals, ids]);
}

/** The words of a weighted parameter; other values have the usual words. */
export const sayRatio = (name: string, value: number): string | undefined =>
  PARTS.some((part) => name.endsWith(`.${part}`)) ? `× ${formatNumber(value, 3)}` : undefined;

/** The displacement that the probabilities make of all models, with its standard deviation. */
export function WeightedEstimate({ id }: { id: string }) {
  const ids = useMemo(() => [id], [id]);
  const { shown, has } = useWeighted(ids);
  const live = useLiveValues(shown);
  if (!has(id, "displacement")) return null;
  return (
    <Figure
      name="weighted output"
      title="Displacements of all models, weighted by their probabilities; ± standard deviation"
    >
      <span ref={live(`${id}.weighted.displacement`)} /> ± <span ref={live(`${id}.weighted.displacement_std`)} />
    </Figure>
  );
}
