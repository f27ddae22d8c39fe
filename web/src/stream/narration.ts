import type { components } from "../api/schema";
import type { Sentence } from "../api/types";

const KEEP = 2000;

/** The sentences of the narrator about the present run, and the number of dropped sentences before them. */
export interface Narration {
  before: number;
  sentences: Sentence[];
}

export const NOTHING_SAID: Narration = { before: 0, sentences: [] };

/** Add the sentences of the server after a number; the page drops its own sentences after that number. */
export function narrate(
  { before, sentences }: Narration,
  { after, sentences: said }: Pick<components["schemas"]["Narrated"], "after" | "sentences">,
): Narration {
  const known = after - before;
  if (known < 0 || known > sentences.length) return { before: after, sentences: said };
  const all = [...sentences.slice(0, known), ...said];
  const lost = Math.max(0, all.length - KEEP);
  return { before: before + lost, sentences: all.slice(lost) };
}
