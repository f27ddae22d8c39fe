/** The groups of results, in their order. */
const GROUPS = ["Places", "Panels", "Scenarios", "Devices", "Settings", "Equations"] as const;

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

/** The entries that match a query, by group; without a query the places and the panels. */
export function find(entries: readonly Entry[], asked: string): [Entry["group"], Entry[]][] {
  const found = ranked(entries, asked);
  const isAll = asked.trim() === "";
  return GROUPS.slice(0, isAll ? 2 : GROUPS.length)
    .map((name): [Entry["group"], Entry[]] => [name, found.filter(({ group }) => group === name)])
    .map(([name, all]): [Entry["group"], Entry[]] => [name, isAll ? all : all.slice(0, MOST)])
    .filter(([, all]) => all.length > 0);
}

/** The entries with every word of a query, the entries with all words in the title first. */
export function ranked<T extends Pick<Entry, "title" | "about" | "words">>(entries: readonly T[], asked: string): T[] {
  const words = asked.toLowerCase().split(/\s+/).filter(Boolean);
  const has = (text: string) => words.every((word) => text.toLowerCase().includes(word));
  const found = entries.filter(({ title, about, words: more = "" }) => has(`${title} ${about} ${more}`));
  return [...found.filter(({ title }) => has(title)), ...found.filter(({ title }) => !has(title))];
}
