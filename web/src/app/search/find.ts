/** The groups of results, in their order. */
export const GROUPS = ["Places", "Panels", "Scenarios", "Devices", "Settings", "Equations"] as const;

export interface Entry {
  group: (typeof GROUPS)[number];
  key: string;
  title: string;
  /** A line that tells it from others of the same title. */
  about: string;
  /** More words by which it is found. */
  words?: string;
  open(): void;
}

/** Most entries of a group that are shown. */
const MOST = 6;

/** The entries with every word that was asked for, those with all in the title first; without words places and panels. */
export function find(entries: readonly Entry[], asked: string): [Entry["group"], Entry[]][] {
  const words = asked.toLowerCase().split(/\s+/).filter(Boolean);
  const has = (text: string) => words.every((word) => text.toLowerCase().includes(word));
  const found = entries.filter(({ title, about, words: more = "" }) => has(`${title} ${about} ${more}`));
  const ranked = [...found.filter(({ title }) => has(title)), ...found.filter(({ title }) => !has(title))];
  const shown = words.length > 0 ? GROUPS : GROUPS.slice(0, 2);
  return shown
    .map((name): [Entry["group"], Entry[]] => [name, ranked.filter(({ group }) => group === name)])
    .map(([name, all]): [Entry["group"], Entry[]] => [name, words.length > 0 ? all.slice(0, MOST) : all])
    .filter(([, all]) => all.length > 0);
}
