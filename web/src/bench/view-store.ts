import { create } from "zustand";
import { isInFrame } from "../api/session";
import { storageName } from "../api/storage-name";
import { addressOf, EARLIER, type PageName, placeOf } from "./places";

const LAYOUT_NAMES = ["lecture", "lab", "research"] as const;

export type LayoutName = (typeof LAYOUT_NAMES)[number];

const CHOSEN = storageName("combbench.layout.chosen");

/** The instance on the bench that the block card shows, such as "plant" or "diagnosers.kalman". */
type CardId = string;

interface ViewStore {
  page: PageName;
  /** The one thing that the page shows of many; empty for all. */
  item: string;
  /** The address names no place. */
  lost: boolean;
  /** A built-in layout, or the name of a user's own. */
  layout: string;
  card: CardId;
  /** The sample of a diagnoser that was clicked, to be explained. */
  sample: { diagnoser: string; tick: number } | undefined;
  dialog: "none" | "keys" | "bench" | "mine" | "share" | "layouts" | "editor" | "record";
  /** On a phone: the view below the scope, unless it is the usual one. */
  extra: string;
  /** Whether the layout is in large type. */
  large: boolean;
  /** Size of the letters on canvases, px: lectures are read from the last row. */
  fontPx: number;
  /** Whether the page shows the panels alone, for an audience. */
  present: boolean;
}

/** Letters on canvases, px, but in a lecture. */
export const NORMAL_PX = 12;
/** Letters of a lecture in its smallest window, px. */
export const LECTURE_PX = 15;

/** How this page looks at the bench; says nothing about the bench itself. */
export const useView = create<ViewStore>(() => ({
  ...placeHere(),
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

function placeHere(): Pick<ViewStore, "page" | "item" | "lost"> {
  const place = placeOf(new URL(window.location.href));
  return { page: "bench", item: "", ...place, lost: place === undefined };
}

/** Show the place that the address names. */
export const showAddress = (): void => useView.setState(placeHere());

/** Go to a place; the address names it, and back works, unless it takes the place of the one before. */
export function openPlace(page: PageName, item = "", replace = false): void {
  const now = useView.getState();
  if (page === now.page && item === now.item && !now.lost) return;
  // a frame of a learning platform loads again at the address of its launch alone
  const url = new URL(isInFrame() ? window.location.href : addressOf({ page, item }));
  url.search = window.location.search;
  for (const name of EARLIER) url.searchParams.delete(name);
  window.history[replace ? "replaceState" : "pushState"](null, "", url);
  useView.setState({ page, item, lost: false });
}

/** Go to a page as a whole. */
export const setPage = (page: PageName): void => openPlace(page);
