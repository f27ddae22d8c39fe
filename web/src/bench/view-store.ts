import { create } from "zustand";

const LAYOUT_NAMES = ["lecture", "lab", "research"] as const;

export type LayoutName = (typeof LAYOUT_NAMES)[number];

const CHOSEN = "combbench.layout.chosen";

/** What the block card shows: an instance on the bench, such as "plant" or "diagnosers.kalman". */
export type CardId = string;

/** What the page shows: the live bench, or what is done around it. */
const PAGE_NAMES = ["bench", "class", "gallery", "runs", "benchmark", "designer", "theory"] as const;

export type PageName = (typeof PAGE_NAMES)[number];

interface ViewStore {
  page: PageName;
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
  const asked = new URLSearchParams(window.location.search).get("page");
  return PAGE_NAMES.find((name) => name === asked) ?? "bench";
}

/** Go to a page; the address names it, and back works. */
export function setPage(page: PageName): void {
  if (page === useView.getState().page) return;
  const url = new URL(window.location.href);
  if (page === "bench") url.searchParams.delete("page");
  else url.searchParams.set("page", page);
  window.history.pushState(null, "", url);
  useView.setState({ page });
}
