import { formatShort, labelsOn } from "./format";

interface TimeUnit {
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

/** Lengths of device time that panels offer, ms. */
export const TIME_WINDOWS_MS = {
  scope: [0.2, 0.5, 1, 2, 4, 10, 20, 50, 100, 200, 500, 1000],
  lanes: [2, 4, 10, 20, 50, 100, 200, 500],
  phase: [1, 2, 4, 10, 20, 40],
} as const satisfies Record<string, readonly number[]>;

/** The items of a menu of lengths, the chosen length included. */
export function windowItems(usualMs: readonly number[], chosenMs: number): { value: string; label: string }[] {
  const all = usualMs.includes(chosenMs) ? usualMs : [...usualMs, chosenMs].sort((a, b) => a - b);
  return all.map((ms) => ({ value: String(ms), label: formatShort(ms, "ms") }));
}
