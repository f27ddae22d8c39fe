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

/** The fitted values of the figures, or the true ones, without missing values. */
export function valuesOf(figures: RateReadout["figures"], which: "value" | "true"): Record<string, number> {
  return Object.fromEntries(figures.flatMap((f) => (f[which] ? [[f.letter, f[which]]] : [])));
}

/** Bounds of the grades of gyroscopes: deg/rt h and deg/h (Georgia Tech's tutorial, IEEE Sensors 2013). */
const WALK = { rate: 0.5, tactical: 0.05, inertial: 0.001 };
const DRIFT = { unusable: 1000, rate: 10, inertial: 0.01 };

/** The grade of an angle random walk, deg/rt h. */
export function walkGrade(walk: number): string {
  if (walk > WALK.rate) return "rate grade";
  if (walk >= WALK.tactical) return "tactical grade";
  return walk < WALK.inertial ? "inertial grade" : "between tactical and inertial grade";
}

/** The grade of a bias instability, deg/h. */
export function driftGrade(drift: number): string {
  if (drift > DRIFT.unusable) return "below rate grade";
  if (drift > DRIFT.rate) return "rate grade";
  return drift >= DRIFT.inertial ? "tactical grade" : "inertial grade";
}
