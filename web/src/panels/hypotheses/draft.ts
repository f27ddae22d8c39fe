import { roundTo } from "../../ui/unit-scale";

/** One hypothesis as a scenario has it: factors on the nominal device; a missing factor is 1. */
export interface Hypothesis {
  name: string;
  mass?: number;
  stiffness?: number;
  damping?: number;
  gain?: number;
}

export const FACTORS = ["mass", "stiffness", "damping", "gain"] as const;
export type Factor = (typeof FACTORS)[number];

export const LEAST = 2;
export const MOST = 16;
const LETTER: Record<Factor, string> = { mass: "m", stiffness: "k", damping: "b", gain: "g" };

/** The usual name of a hypothesis, by its factors: m+5, k-10b+30, healthy. */
export function usualName(hypothesis: Omit<Hypothesis, "name">): string {
  const parts = FACTORS.flatMap((factor) => {
    const percent = roundTo(((hypothesis[factor] ?? 1) - 1) * 100, 6);
    return percent === 0 ? [] : [`${LETTER[factor]}${percent > 0 ? "+" : ""}${percent}`.replace(".", ",")];
  });
  return parts.join("") || "healthy";
}

/** Change a factor; a usual name follows. */
export function withFactor(hypothesis: Hypothesis, factor: Factor, percent: number): Hypothesis {
  const next = { ...hypothesis, [factor]: roundTo(1 + percent / 100, 10) };
  return { ...next, name: hypothesis.name === usualName(hypothesis) ? usualName(next) : hypothesis.name };
}

/** A new hypothesis: more mass, in steps of 5 %. */
export function another(list: readonly Hypothesis[]): Hypothesis {
  for (let percent = 5; ; percent += 5) {
    const made = { mass: 1 + percent / 100 };
    const name = usualName(made);
    if (list.every((h) => h.name !== name)) return { name, ...made };
  }
}

/** The reason against a list, in words. */
export function refusal(list: readonly Hypothesis[]): string | undefined {
  if (list.length < LEAST) return `A bank needs at least ${LEAST} hypotheses.`;
  const names = list.map((h) => h.name);
  const bad = names.find((name) => !/^[^\s.]{1,24}$/.test(name));
  if (bad !== undefined) return `"${bad}" cannot be a name: use up to 24 characters, without spaces or dots.`;
  const twice = names.find((name, i) => names.indexOf(name) !== i);
  return twice === undefined ? undefined : `${twice} appears twice.`;
}
