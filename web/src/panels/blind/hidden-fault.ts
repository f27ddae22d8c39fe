import type { Command } from "../../api/types";
import { roundTo } from "../../ui/unit-scale";
import type { Hypothesis } from "../hypotheses/draft";

/** What is hidden: one of the hypotheses, and how long after the start it comes. */
export interface HiddenFault {
  answer: string;
  /** Ticks from the start of the game to the fault. */
  delayTicks: number;
}

/** Faults that make a hypothesis true, by the factor it changes. */
const FAULT_OF = { mass: "added_mass", stiffness: "stiffness", damping: "damping", gain: "drive_gain" } as const;
const LEAST_MS = 2;
const MOST_MS = 8;

/** What a seed hides; the same seed hides the same, and healthy is among it. */
export function hiddenFault(seed: number, names: readonly string[], dtMs: number): HiddenFault {
  const answer = names[Math.floor(uniform(seed, 1) * names.length)];
  return { answer, delayTicks: Math.round((LEAST_MS + uniform(seed, 2) * (MOST_MS - LEAST_MS)) / dtMs) };
}

/** The commands that make a hypothesis true. */
export function faultsOf(hypothesis: Hypothesis): Command[] {
  return (Object.keys(FAULT_OF) as (keyof typeof FAULT_OF)[]).flatMap((factor): Command[] => {
    const severity = roundTo((hypothesis[factor] ?? 1) - 1, 10);
    if (severity === 0) return [];
    return [{ fault: FAULT_OF[factor], severity }];
  });
}

/** A number from 0 to 1 that depends on seed and stream alone (splitmix32). */
function uniform(seed: number, stream: number): number {
  let z = (Math.imul(seed, 0x9e3779b9) + Math.imul(stream, 0x85ebca6b)) >>> 0;
  z = Math.imul(z ^ (z >>> 16), 0x21f0aaad);
  z = Math.imul(z ^ (z >>> 15), 0x735a2d97);
  return ((z ^ (z >>> 15)) >>> 0) / 2 ** 32;
}

/**
 * Points for an answer given with a confidence, by Brier's rule: 100 for right and sure, 0 for wrong and sure.
 *
 * The rest of the confidence is spread over the other answers, so saying what one believes pays best.
 */
export function points(right: boolean, confidence: number, answers: number): number {
  const rest = (1 - confidence) / (answers - 1);
  const own = right ? (1 - confidence) ** 2 : confidence ** 2;
  const others = right ? (answers - 1) * rest ** 2 : (1 - rest) ** 2 + (answers - 2) * rest ** 2;
  return 100 * (1 - (own + others) / 2);
}
