import { useMemo } from "react";
import { useBench } from "../../stream/bench-store";
import { Figure } from "../../ui/figure";
import { formatNumber } from "../../ui/format";
import { useLiveValues } from "../schematic/use-live-values";

/** Signals of the weighted state, by their last word, each with a standard deviation; a bank without states has none. */
export const STATE = ["displacement", "velocity"] as const;
/** The same of a device with two axes. */
export const AXES_STATE = ["x", "y", "rate"] as const;
/** Weighted parameters over nominal. */
export const PARTS = ["mass", "stiffness", "damping"] as const;
/** The same of a device with two axes alone: the stiffness of y, and the stiffness between the axes read as a rate. */
export const AXES_PARTS = ["second_stiffness", "quadrature"] as const;
const PORTS = [...[...STATE, ...AXES_STATE].flatMap((port) => [port, `${port}_std`]), ...PARTS, ...AXES_PARTS];
const RATIOS: readonly string[] = [...PARTS, "second_stiffness"];

/** The diagnosers among these with signals of a weighted estimate; while a fault is hidden none has. */
export function useWeighted(ids: readonly string[]) {
  const signals = useBench((s) => s.bench?.signals);
  return useMemo(() => {
    const known = new Set(signals?.map(({ name }) => name));
    const names = ids.flatMap((id) => PORTS.map((port) => `${id}.weighted.${port}`));
    const shown = Object.fromEntries(names.filter((name) => known.has(name)).map((name) => [name, name]));
    return { shown, has: (id: string, port: string) => `${id}.weighted.${port}` in shown };
  }, [signals, ids]);
}

/** The words of a weighted parameter; other values have the usual words. */
export const sayRatio = (name: string, value: number): string | undefined =>
  RATIOS.some((part) => name.endsWith(`.${part}`)) ? `× ${formatNumber(value, 3)}` : undefined;

/** The displacement, or the rate of a device with axes, that the probabilities make of all models. */
export function WeightedEstimate({ id }: { id: string }) {
  const ids = useMemo(() => [id], [id]);
  const { shown, has } = useWeighted(ids);
  const live = useLiveValues(shown);
  const port = ["displacement", "rate"].find((name) => has(id, name));
  if (!port) return null;
  return (
    <Figure
      name={port === "rate" ? "weighted rate" : "weighted output"}
      title={`The ${port} of all models, weighted by their probabilities; ± standard deviation`}
    >
      <span ref={live(`${id}.weighted.${port}`)} /> ± <span ref={live(`${id}.weighted.${port}_std`)} />
    </Figure>
  );
}
