import type { GalleryCard } from "../api/types";

/** Verdicts from best to worst, as the library writes them. */
export const VERDICTS = ["reproduced", "reproduced by tuning", "partly", "not reproduced"] as const;

export interface GalleryFilter {
  /** A chapter, an appendix, or "all". */
  chapter: string;
  /** One of the verdicts, "open" for what has not been run or does not hold, or "all". */
  verdict: string;
  words: string;
}

export const EVERYTHING: GalleryFilter = { chapter: "all", verdict: "all", words: "" };

/** The chapter a scenario belongs to, from its id: "ch3-..." is "3", "appA-..." is "A", gyroscopes go with chapter 6; anything else is a live bench. */
export function chapterOf(id: string): string {
  if (id.startsWith("gyro-")) return "6";
  return /^(?:ch(\d+)|app([A-Z]))-/.exec(id)?.slice(1).find(Boolean) ?? "live";
}

/** Where a chapter stands in the book; live benches come first, appendices last. */
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

/** The cards a filter leaves, in the order of the book. */
export function chosen(cards: readonly GalleryCard[], filter: GalleryFilter): GalleryCard[] {
  const words = filter.words.toLowerCase().split(/\s+/).filter(Boolean);
  const left = cards.filter((card) => {
    if (filter.chapter !== "all" && chapterOf(card.id) !== filter.chapter) return false;
    if (filter.verdict === "open" && card.ok === true) return false;
    if (filter.verdict !== "all" && filter.verdict !== "open" && card.verdict !== filter.verdict) return false;
    const text = `${card.id} ${card.title} ${card.summary} ${card.claim} ${card.source}`.toLowerCase();
    return words.every((word) => text.includes(word));
  });
  return left.sort(byChapter);
}
