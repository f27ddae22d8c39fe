import type { Bench } from "../../api/types";

/** A diagnoser as the race shows it: what its bands are called, and which signals feed it. */
export interface Contestant {
  id: string;
  /** Of the hypotheses, or of the states of one that does not choose between hypotheses. */
  names: string[];
  probabilities: string[];
  /** Signal of the index that the band of verdicts shows. */
  verdict: string;
  /** Whether the bench knows which of the names is true. */
  truth: boolean;
}

/** States of the diagnosers that say something else than a hypothesis, by the signal that says it. */
const STATES: Record<string, string[]> = {
  region: ["required", "degraded", "unacceptable", "danger"],
  alarm: ["quiet", "alarm"],
};

/** Whatever on a bench has a verdict; those that choose between hypotheses first. */
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
