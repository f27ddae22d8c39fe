import { formatNumber } from "./format";

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
  const step = splitsMs.length > 1 ? Math.abs(splitsMs[1] - splitsMs[0]) * factor : 1;
  const decimals = Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-6)));
  return splitsMs.map((ms) => formatNumber(ms * factor, decimals));
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

/** Device time, for readouts: always microseconds' resolution, fixed width. */
export function formatDeviceTime(ms: number): string {
  const s = ms / 1000;
  if (!Number.isFinite(s)) return "–";
  const [whole, fraction] = s.toFixed(6).split(".");
  return `${whole.replace(/\B(?=(\d{3})+$)/g, "\u2009")}.${fraction.slice(0, 3)}\u2009${fraction.slice(3)}`;
}
