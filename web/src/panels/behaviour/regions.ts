import { formatPercent, formatSi } from "../../ui/format";

/** Losses at which the next region begins, and the displacement beyond which there is danger. */
export interface Limits {
  degraded: number;
  unacceptable: number;
  danger: number;
  dangerUm: number;
}

/** Where the device was at moments up to now: its loss of performance and its largest displacement. */
export interface Path {
  loss: number[];
  peakUm: number[];
}

export const REGIONS = ["required", "degraded", "unacceptable", "danger"];

/** The largest displacement about each moment, over as many columns as a period has. */
export function peaks(low: ArrayLike<number>, high: ArrayLike<number>, columns: number): number[] {
  const sizes = Array.from({ length: low.length }, (_, i) => Math.max(Math.abs(low[i]), Math.abs(high[i])));
  return sizes.map((_, i) => Math.max(...sizes.slice(Math.max(0, i + 1 - columns), i + 1)));
}

/** The region of the device in a sentence. */
export function regionsWords({ loss, peakUm }: Path, region: number): string {
  const last = loss.length - 1;
  const name = REGIONS[region] ?? "unknown";
  const where = region === 3 ? "The device is in danger" : `Performance is ${name}`;
  return `${where}: ${formatPercent(loss[last])} from the healthy motion, at most ${formatSi(peakUm[last], "um", 3)} from rest.`;
}
