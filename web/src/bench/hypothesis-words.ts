import type { Bench } from "../api/types";
import { cardOf } from "../api/use-catalog";
import { useBench } from "../stream/bench-store";
import { formatChange } from "../ui/format";

type Diagnosers = Bench["diagnosers"];

/** Factors whose name says too little. */
const NOUNS: Partial<Record<string, string>> = {
  gain: "drive gain",
  second_stiffness: "stiffness along y",
};

/** Of the device, as hypotheses are named by them. */
const LETTERS: Record<string, string> = { m: "mass", k: "stiffness", b: "damping" };

let known: { diagnosers: Diagnosers; words: Map<string, string> } | undefined;

/** Abbreviations contain a number; a name of words was chosen by its author, and is kept. */
const ABBREVIATION = /\d/;

/** A hypothesis in words: "m+5" reads "mass +5 %"; a hypothesis without factors keeps its name. */
export function hypothesisWords(name: string, diagnosers = useBench.getState().bench?.diagnosers): string {
  if (!diagnosers) return spelledOut(name);
  if (known?.diagnosers !== diagnosers) known = { diagnosers, words: wordsOf(diagnosers) };
  return known.words.get(name) ?? spelledOut(name);
}

/** The abbreviation of a bench elsewhere, as in a vote of another bench. */
function spelledOut(name: string): string {
  const [, noun, percent] = /^([mkb])([+-]\d+)$/.exec(name) ?? [];
  return noun ? `${LETTERS[noun]} ${formatChange(Number(percent), "%", 0)}` : name;
}

/** A diagnoser by the title of its block, and by its own name where it has one. */
export function diagnoserWords(id: string, diagnosers: Diagnosers | undefined): string {
  const kind = diagnosers?.[id]?.kind ?? id;
  const name = id.replaceAll("_", " ");
  const title = cardOf("diagnose", kind)?.title;
  return !title ? name : id === kind ? title : `${title}, ${name}`;
}

/** Hypotheses with their words, for a title: "m+5: mass +5 %". */
export function hypothesesExplained(names: readonly string[]): string {
  return names
    .map((name) => [name, hypothesisWords(name)])
    .map(([name, words]) => (name === words ? name : `${name}: ${words}`))
    .join("\n");
}

function wordsOf(diagnosers: Diagnosers): Map<string, string> {
  const words = new Map<string, string>();
  for (const { names, factors } of Object.values(diagnosers))
    names.forEach((name, i) => {
      const said = Object.entries(factors[i] ?? {}).map(([factor, value]) => factorWords(factor, value));
      if (said.length > 0 && ABBREVIATION.test(name) && !words.has(name)) words.set(name, said.join(", "));
    });
  return words;
}

/** A factor on the nominal device in percent, or an offset in its unit. */
function factorWords(factor: string, value: number): string {
  if (factor.endsWith("_dps")) return `${factor.slice(0, -4).replaceAll("_", " ")} ${formatChange(value, "deg/s", 0)}`;
  const percent = (value - 1) * 100;
  const noun = NOUNS[factor] ?? factor.replaceAll("_", " ");
  return `${noun} ${formatChange(percent, "%", Math.abs(percent - Math.round(percent)) < 1e-6 ? 0 : 1)}`;
}
