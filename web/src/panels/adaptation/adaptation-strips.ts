import type { Signal } from "../../api/types";
import { groupBy } from "../../ui/group-by";

/** Another signal on the same axis, in a colour of its own. */
interface Rival {
  signal: string;
  /** Slot in `TRACE_COLOURS`. */
  slot: number;
}

/** One field of the adaptation view: an inner signal and its ideal value. */
export interface Strip {
  title: string;
  unit: string;
  signal: string;
  /** Slot in `TRACE_COLOURS`, unless the usual one. */
  slot?: number;
  rivals?: Rival[];
  /** Its ideal value, which needs a known device. */
  ideal?: string;
  /** A sign that theory forbids is worth seeing. */
  negative?: boolean;
  /** Edges of the boundary layer, either side of zero. */
  layer?: number;
}

/** A block that adapts, estimates or slides, with its strips. */
interface AdaptiveUnit {
  block: string;
  strips: Strip[];
}

/** Vectors with their ideal values, by the name of the port. */
const PAIRS: Record<string, [string, string]> = {
  gain: ["gain_ideal", "gain"],
  parameter: ["parameter_true", "parameter"],
  estimate: ["truth", "estimate of"],
};

/** Scalars in the order they are shown. */
const SCALARS: Record<string, string> = {
  surface: "s, distance from the surface",
  lyapunov: "V",
  lyapunov_rate: "dV/dt by theory",
  error: "error",
  own_error: "error, had it driven",
  augmented_error: "augmented error",
  auxiliary_error: "auxiliary error",
  prediction_error: "prediction error",
  alpha: "gain of the auxiliary error",
  error_pct: "largest error",
  forgetting: "forgetting factor",
  trace: "trace of the covariance",
  covariance_trace: "trace of the covariance",
};

/** Every signal a strip needs. */
export const signalsOf = ({ signal, ideal, rivals = [] }: Strip): string[] => [
  signal,
  ...(ideal ? [ideal] : []),
  ...rivals.map((r) => r.signal),
];

/** A block with one of these signals adapts; an error alone does not count. */
const ADAPTS = /^(gain|parameter|estimate)\.|^(gain|surface|lyapunov)$/;

/** Every unit of a bench that adapts, with its strips. */
export function adaptiveUnits(signals: readonly Signal[], layers: Record<string, number> = {}): AdaptiveUnit[] {
  const names = new Map(signals.map((s) => [s.name, s]));
  const ofBlocks = signals.filter(({ name }) => name.includes("."));
  return groupBy(ofBlocks, ({ name }) => name.split(".")[0]).flatMap(([block, own]): AdaptiveUnit[] => {
    const port = (signal: Signal) => signal.name.slice(block.length + 1);
    if (block === "faults" || !own.some((s) => ADAPTS.test(port(s)))) return [];
    const strips: Strip[] = own.flatMap((signal) => {
      const [head, label] = port(signal).split(".");
      const pair = PAIRS[head];
      if (!pair) return [];
      const ideal = `${block}.${pair[0]}${label ? `.${label}` : ""}`;
      const title = label ? `${pair[1]} ${label}` : pair[1];
      return [{ title, unit: signal.unit, signal: signal.name, ideal: names.has(ideal) ? ideal : undefined }];
    });
    for (const [scalar, title] of Object.entries(SCALARS)) {
      const signal = names.get(`${block}.${scalar}`);
      if (!signal) continue;
      strips.push({
        title,
        unit: signal.unit,
        signal: signal.name,
        negative: scalar === "lyapunov_rate",
        layer: scalar === "surface" ? layers[block] : undefined,
      });
    }
    return [{ block, strips }];
  });
}
