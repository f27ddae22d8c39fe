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
