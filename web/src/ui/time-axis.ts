import { labelsOn } from "./format";

export interface TimeUnit {
  unit: "µs" | "ms" | "s";
  /** Shown value = ms x factor. */
  factor: number;
}

/** The unit in which a span of device time reads well. */
export function timeUnit(spanMs: number): TimeUnit {
  if (spanMs < 0.5) return { unit: "µs", factor: 1000 };
  if (spanMs < 2000) return { unit: "ms", factor: 1 };
  return { unit: "s", factor: 1e-3 };
}

/** Labels of a time axis: as many decimals as its steps need, and no more. */
export function timeLabels(splitsMs: readonly number[], spanMs: number): string[] {
  const { factor } = timeUnit(spanMs);
  return labelsOn({ factor, exponent: "" }, splitsMs);
}

/** Round values across a span of time. */
export { linearTicks as timeSplits } from "./ticks";
