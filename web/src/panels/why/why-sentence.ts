import type { Account, ModelAccount, Turn } from "../../api/types";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { capital } from "../../ui/capital";
import { formatNumber } from "../../ui/format";

/** More than rounding between the recorded and the computed value: the bank did not take the sample for evidence. */
const PARTED = 0.01;

/** The verdict at a sample in one sentence, from the numbers of the bank. */
export function whySentence({ models, evidence, residuals }: Account, turn: Turn | undefined, tick: number): string {
  const winner = likeliest(models);
  const first = atStart(winner.name);
  if (models.some((m) => Math.abs(m.recorded - m.posterior) > PARTED))
    return `${first} stays ahead: this sample did not count, because the drive was too small or nothing was measured.`;
  if (models.every((m) => m.recorded === winner.recorded)) return "The hypotheses are all alike so far.";
  if (models.some((m) => m.log_likelihood === null)) return `${first} stays ahead: this sample tells nothing.`;
  const others = models.filter((m) => m !== winner);
  const beaten = turn?.tick === tick ? others.find((m) => m.name === turn.before) : undefined;
  const rival = beaten ?? (winner === models[0] ? likeliest(others) : models[0]);
  const second = hypothesisWords(rival.name);
  const [own, other] = [sigmas(winner), sigmas(rival)];
  const how = evidence ? " the tone of the drive" : residuals.length > 1 ? " on both axes together" : "";
  if (own === other) return `${first} wins by the samples before: here it and ${second} both miss${how} by ${own}.`;
  if (winner.missed_sigma < rival.missed_sigma)
    return `${first} wins: it misses${how} by ${own}, ${second} by ${other}.`;
  return `${first} wins by the samples before: here it misses${how} by ${own}, ${second} only by ${other}.`;
}

/** A hypothesis at the beginning of a sentence: its words with a capital, a mere name as it is. */
function atStart(name: string): string {
  const words = hypothesisWords(name);
  return words === name ? name : capital(words);
}

const sigmas = ({ missed_sigma }: ModelAccount) => `${formatNumber(missed_sigma, 1)} σ`;

/** The model the bank believed most; the first of several alike. */
export function likeliest(models: ModelAccount[]): ModelAccount {
  return models.reduce((top, m) => (m.recorded > top.recorded ? m : top));
}

/** Where the verdict last turned, in words. */
export function turnWords({ tick, before, since }: Turn, shown: number): string {
  if (tick === null) return `The verdict has not turned since sample ${since}, the first one kept.`;
  const from = before ? `, from ${hypothesisWords(before)}` : "";
  return tick === shown
    ? `The verdict turned at this sample${from}.`
    : `The verdict last turned at sample ${tick}${from}.`;
}
