/** One response over frequency. */
export interface BodeCurve {
  name: string;
  /** In `TRACE_COLOURS` and in `DASHES`. */
  slot: number;
  dash: number;
  hertz: number[];
  db: number[];
  deg: number[];
}

/** A band of responses. */
export interface BodeBand {
  name: string;
  hertz: number[];
  db: { low: number[]; high: number[] };
  deg: { low: number[]; high: number[] };
}

/** Measured tones with the error of the magnitude. */
export interface BodePoints {
  name: string;
  /** In `TRACE_COLOURS`. */
  slot: number;
  hertz: number[];
  db: number[];
  errorDb: number[];
  deg: number[];
}

export const decibels = (ratio: number): number => 20 * Math.log10(Math.max(Math.abs(ratio), 1e-12));

/** Ends of an axis that holds all values with a little air, on round numbers. */
export function dbRange(values: number[]): [number, number] {
  const finite = values.filter(Number.isFinite);
  const low = Math.min(...finite, 0);
  const high = Math.max(...finite, 0);
  return [Math.max(-120, Math.floor(low / 10) * 10), Math.ceil((high + 2) / 10) * 10];
}

/** Index of the sample nearest to a frequency, on a logarithmic axis. */
export function nearest(hertz: readonly number[], at: number): number {
  let best = 0;
  hertz.forEach((f, i) => {
    if (Math.abs(Math.log(f / at)) < Math.abs(Math.log(hertz[best] / at))) best = i;
  });
  return best;
}
