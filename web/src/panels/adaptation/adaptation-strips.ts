import type { Signal } from "../../api/types";

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
  const blocks = new Map<string, Signal[]>();
  for (const signal of signals) {
    const dot = signal.name.indexOf(".");
    if (dot > 0) blocks.set(signal.name.slice(0, dot), [...(blocks.get(signal.name.slice(0, dot)) ?? []), signal]);
  }
  return [...blocks].flatMap(([block, own]): AdaptiveUnit[] => {
    const port = (signal: Signal) => signal.name.slice(block.length + 1);
    if (own[0].name.startsWith("faults.") || !own.some((s) => ADAPTS.test(port(s)))) return [];
    const strips: Strip[] = own.flatMap((signal) => {
      const [head, label] = port(signal).split(".");
      const pair = PAIRS[head];
      if (!pair) return [];
      const ideal = `${block}.${pair[0]}${label ? `.${label}` : ""}`;
      return [
        {
          title: label ? `${pair[1]} ${label}` : pair[1],
          unit: signal.unit,
          signal: signal.name,
          ...(names.has(ideal) ? { ideal } : {}),
        },
      ];
    });
    for (const [scalar, title] of Object.entries(SCALARS)) {
      const signal = names.get(`${block}.${scalar}`);
      if (!signal) continue;
      const layer = scalar === "surface" ? layers[block] : undefined;
      strips.push({
        title,
        unit: signal.unit,
        signal: signal.name,
        ...(scalar === "lyapunov_rate" ? { negative: true } : {}),
        ...(layer ? { layer } : {}),
      });
    }
    return [{ block, strips }];
  });
}
