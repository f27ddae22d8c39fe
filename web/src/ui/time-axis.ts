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

/** Steps of 1, 2 or 5 that put at most `most` marks on a span. */
export function timeSplits(startMs: number, endMs: number, most: number): number[] {
  const span = endMs - startMs;
  if (!(span > 0) || most < 1) return [];
  const raw = span / most;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((m) => power * m >= raw * 0.9999) ?? 10);
  const splits: number[] = [];
  for (let i = Math.ceil(startMs / step - 1e-9); i * step <= endMs + step * 1e-9; i += 1) splits.push(i * step);
  return splits;
}
