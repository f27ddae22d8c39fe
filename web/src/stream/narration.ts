import type { components } from "../api/schema";
import type { Sentence } from "../api/types";

const KEEP = 2000;

/** What the narrator says of the present run, and how many sentences before them the page has no more. */
export interface Narration {
  before: number;
  sentences: Sentence[];
}

export const NOTHING_SAID: Narration = { before: 0, sentences: [] };

/** Add what the server says: the sentences behind a number; those the page had behind it are void. */
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
