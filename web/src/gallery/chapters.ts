import type { GalleryCard } from "../api/types";

export interface GalleryFilter {
  /** A chapter, an appendix, or "all". */
  chapter: string;
  /** One of the verdicts, "open" for claims that are not measured or do not hold, or "all". */
  verdict: string;
  words: string;
}

export const EVERYTHING: GalleryFilter = { chapter: "all", verdict: "all", words: "" };

/** The chapter a scenario belongs to, from its id: "ch3-..." is "3", "appA-..." is "A", gyroscopes go with chapter 6; anything else is a live bench. */
export function chapterOf(id: string): string {
  if (id.startsWith("gyro-")) return "6";
  return /^(?:ch(\d+)|app([A-Z]))-/.exec(id)?.slice(1).find(Boolean) ?? "live";
}

/** The place of a chapter in the book; live benches come first, appendices last. */
const rank = (name: string) => (name === "live" ? 0 : /\d/.test(name) ? Number(name) : 100 + name.charCodeAt(0));

/** The chapters that occur, in the order of the book. */
export function chaptersOf(cards: readonly GalleryCard[]): string[] {
  return [...new Set(cards.map((card) => chapterOf(card.id)))].sort((a, b) => rank(a) - rank(b));
}

/** The order of the book, then by id. */
export const byChapter = (a: { id: string }, b: { id: string }): number =>
  rank(chapterOf(a.id)) - rank(chapterOf(b.id)) || a.id.localeCompare(b.id);

/** How a chapter is called. */
export function chapterName(chapter: string): string {
  if (chapter === "live") return "Live benches";
  return /\d/.test(chapter) ? `Chapter ${chapter}` : `Appendix ${chapter}`;
}

/** The places of a word in a card, with the weight of each. */
const PLACES: readonly [number, (card: GalleryCard) => string][] = [
  [8, (card) => card.id.replaceAll("-", " ")],
  [6, (card) => card.title],
  [4, (card) => card.topics.join(" ")],
  [3, (card) => `${chapterName(chapterOf(card.id))} ${card.id}`],
  [1, (card) => `${card.source} ${card.summary} ${card.claim}`],
];

/** How well a card fits a word: the weight of its best place, doubled at the start of a word; 0 without a match. */
function weightOf(card: GalleryCard, word: string): number {
  const isNumber = /^\d+$/.test(word); // which is no part of another number
  const start = new RegExp(
    `(?:^|[\\s(-])${word.replaceAll(/[\\^$.*+?()[\]{}|]/g, "\\$&")}${isNumber ? "(?![\\d.]*\\d)" : ""}`,
  );
  let best = 0;
  for (const [weight, of] of PLACES) {
    const text = of(card).toLowerCase();
    if (start.test(text)) best = Math.max(best, 2 * weight);
    else if (!isNumber && text.includes(word)) best = Math.max(best, weight);
  }
  return best;
}

/** The cards a filter leaves: without words demos first, then in the order of the book; with words the best fit first. */
export function chosen(cards: readonly GalleryCard[], filter: GalleryFilter): GalleryCard[] {
  const words = filter.words.toLowerCase().split(/\s+/).filter(Boolean);
  return cards
    .filter((card) => {
      if (filter.chapter !== "all" && chapterOf(card.id) !== filter.chapter) return false;
      if (filter.verdict === "open") return card.ok !== true;
      return filter.verdict === "all" || card.verdict === filter.verdict;
    })
    .map((card) => ({ card, fits: words.map((word) => weightOf(card, word)) }))
    .filter(({ fits }) => fits.every((one) => one > 0))
    .map(({ card, fits }) => ({ card, total: fits.reduce((sum, one) => sum + one, 0) }))
    .sort((a, b) => b.total - a.total || Number(b.card.demo) - Number(a.card.demo) || byChapter(a.card, b.card))
    .map(({ card }) => card);
}
