import { create } from "zustand";

const LAYOUT_NAMES = ["lecture", "lab", "research"] as const;

export type LayoutName = (typeof LAYOUT_NAMES)[number];

const CHOSEN = "combbench.layout.chosen";

/** What the block card shows: an instance on the bench, such as "plant" or "diagnosers.kalman". */
export type CardId = string;

/** What the page shows: the live bench, or what is done around it. */
const PAGE_NAMES = ["bench", "class", "gallery", "runs", "designer", "theory"] as const;

export type PageName = (typeof PAGE_NAMES)[number];

/** Pages of earlier links, and where their contents are now. */
const MOVED: Record<string, { page: PageName; tab: string }> = {
  benchmark: { page: "runs", tab: "scores" },
  scores: { page: "runs", tab: "scores" },
};

interface ViewStore {
  page: PageName;
  /** The tab of the page in front, if the address names one. */
  tab: string | undefined;
  /** A built-in one, or the name of one of one's own. */
  layout: string;
  card: CardId;
  /** The sample of a diagnoser that was clicked, to be explained. */
  sample: { diagnoser: string; tick: number } | undefined;
  dialog: "none" | "keys" | "bench" | "mine" | "share" | "layouts" | "editor";
  /** On a phone: the view below the scope, unless it is the usual one. */
  extra: string;
  /** Whether the layout is in large type. */
  large: boolean;
  /** Size of the letters on canvases, px: lectures are read from the last row. */
  fontPx: number;
  /** Only what an audience looks at. */
  present: boolean;
}

/** Letters on canvases, px, but in a lecture. */
export const NORMAL_PX = 12;
/** Those of a lecture, in the smallest window it is made for. */
export const LECTURE_PX = 15;

/** How this page looks at the bench; says nothing about the bench itself. */
export const useView = create<ViewStore>(() => ({
  page: pageInAddress(),
  tab: tabInAddress(),
  layout: firstLayout(),
  card: "diagnosers.kalman",
  sample: undefined,
  dialog: "none",
  extra: "",
  large: firstLayout() === "lecture",
  fontPx: NORMAL_PX,
  present: new URLSearchParams(window.location.search).get("present") === "1",
}));

/** The layout named in the address, else the one chosen last; a lecture for who comes first. */
function firstLayout(): string {
  const asked = new URLSearchParams(window.location.search).get("layout");
  return LAYOUT_NAMES.find((name) => name === asked) ?? localStorage.getItem(CHOSEN) ?? "lecture";
}

/** Keep a layout for the next visit; the address names it. */
export function chooseLayout(layout: string): void {
  localStorage.setItem(CHOSEN, layout);
  const url = new URL(window.location.href);
  url.searchParams.set("layout", layout);
  window.history.replaceState(null, "", url);
}

/** The page named in the address. */
export function pageInAddress(): PageName {
  const asked = inAddress("page");
  return MOVED[asked]?.page ?? PAGE_NAMES.find((name) => name === asked) ?? "bench";
}

/** The tab of the page named in the address. */
export function tabInAddress(): string | undefined {
  return MOVED[inAddress("page")]?.tab ?? (inAddress("tab") || undefined);
}

function inAddress(name: "page" | "tab"): string {
  return new URLSearchParams(window.location.search).get(name) ?? "";
}

/** Show a tab of the page; the address names it. */
export function showTab(tab: string): void {
  const url = new URL(window.location.href);
  url.searchParams.set("page", useView.getState().page);
  url.searchParams.set("tab", tab);
  window.history.replaceState(null, "", url);
  useView.setState({ tab });
}

/** Go to a page; the address names it, and back works. */
export function setPage(page: PageName): void {
  if (page === useView.getState().page) return;
  const url = new URL(window.location.href);
  url.searchParams.delete("tab");
  if (page === "bench") url.searchParams.delete("page");
  else url.searchParams.set("page", page);
  window.history.pushState(null, "", url);
  useView.setState({ page, tab: undefined });
}
