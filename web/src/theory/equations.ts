import type { BlockCard, Equation } from "../api/types";

/** An equation of the catalogue and the blocks of a family that have it. */
export interface Entry {
  family: string;
  blocks: string[];
  equation: Equation;
  /** All it can be found by, in lower case. */
  words: string;
}

export interface Family {
  name: string;
  entries: Entry[];
}

const wordsOf = (block: BlockCard, { label, source, why, printed, latex }: Equation) =>
  [block.title, block.name, block.family, label, source, why, printed, latex].join(" ").replaceAll("_", " ");

/** Every equation of the catalogue, in its order; an equation that blocks of a family share appears once. */
export function entriesOf(blocks: readonly BlockCard[]): Entry[] {
  const entries = new Map<string, Entry>();
  for (const block of blocks)
    for (const equation of block.equations) {
      const key = JSON.stringify([block.family, equation]);
      const { blocks: others, words } = entries.get(key) ?? { blocks: [], words: "" };
      entries.set(key, {
        family: block.family,
        blocks: [...others, block.title],
        equation,
        words: `${words} ${wordsOf(block, equation).toLowerCase()}`,
      });
    }
  return [...entries.values()];
}

/** The equations that have every word asked for, by family; the errata alone if so wished. */
export function found(entries: readonly Entry[], asked: string, errataOnly: boolean): Family[] {
  const words = asked.toLowerCase().split(/\s+/).filter(Boolean);
  const families = new Map<string, Entry[]>();
  for (const entry of entries) {
    if (errataOnly && !entry.equation.printed) continue;
    if (!words.every((word) => entry.words.includes(word))) continue;
    families.set(entry.family, [...(families.get(entry.family) ?? []), entry]);
  }
  return [...families].map(([name, list]) => ({ name, entries: list }));
}
