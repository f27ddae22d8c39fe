import type { RateReadout } from "../../api/types";

const SECONDS_PER_HOUR = 3600;
const FLOOR = Math.sqrt((2 * Math.LN2) / Math.PI);

/** Allan deviation in deg/h of each noise alone over tau in s: N in deg/rt h, B in deg/h, K in deg/h/rt h. */
export const TERMS: Record<string, (value: number, tauS: number) => number> = {
  N: (n, tau) => n / Math.sqrt(tau / SECONDS_PER_HOUR),
  B: (b) => FLOOR * b,
  K: (k, tau) => k * Math.sqrt(tau / SECONDS_PER_HOUR / 3),
};

/** The deviation of all three together. */
export function deviation(values: Record<string, number>, tauS: number): number {
  return Math.hypot(...Object.entries(values).map(([letter, value]) => TERMS[letter](value, tauS)));
}

/** Standard error of a deviation from so many pairs of means, as a share of it. */
export function scatter(octave: number, pairs: number): number {
  const overlap = Math.min(2 ** octave, 8);
  return 1 / Math.sqrt(2 * ((pairs - 1) / overlap + 1));
}

/** The values of the figures that the record tells, or those that are true; those that are not there left out. */
export function valuesOf(figures: RateReadout["figures"], which: "value" | "true"): Record<string, number> {
  return Object.fromEntries(figures.flatMap((f) => (f[which] ? [[f.letter, f[which]]] : [])));
}
