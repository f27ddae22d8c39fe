import type { Bench } from "../../api/types";

/** A diagnoser as the race shows it: the names of its bands, and its signals. */
export interface Contestant {
  id: string;
  /** Of its hypotheses, or of its states where it has no hypotheses. */
  names: string[];
  probabilities: string[];
  /** Signal of the index that the band of verdicts shows. */
  verdict: string;
  /** Whether the bench knows which of the names is true. */
  truth: boolean;
}

/** States of diagnosers without hypotheses, by their signal. */
const STATES: Record<string, string[]> = {
  region: ["required", "degraded", "unacceptable", "danger"],
  alarm: ["quiet", "alarm"],
};

/** The diagnosers of a bench with a verdict; diagnosers with hypotheses come first. */
export function contestants(bench: Pick<Bench, "diagnosers" | "signals">): Contestant[] {
  const known = new Set(bench.signals.map((s) => s.name));
  const found = Object.entries(bench.diagnosers).flatMap(([id, { names }]): Contestant[] => {
    const probabilities = names.map((name) => `${id}.probability.${name}`).filter((name) => known.has(name));
    if (known.has(`${id}.winner`)) {
      const truth = known.has(`${id}.truth`); // not while a fault is hidden
      return [{ id, names, probabilities, verdict: `${id}.winner`, truth }];
    }
    const state = Object.keys(STATES).find((port) => known.has(`${id}.${port}`));
    return state ? [{ id, names: STATES[state], probabilities: [], verdict: `${id}.${state}`, truth: false }] : [];
  });
  return found.sort((a, b) => Number(b.truth) - Number(a.truth));
}
