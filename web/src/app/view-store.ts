import { create } from "zustand";

export type LayoutName = "lecture" | "lab" | "research";

/** What the block card shows: an instance on the bench, such as "plant" or "diagnosers.kalman". */
export type CardId = string;

interface ViewStore {
  layout: LayoutName;
  card: CardId;
  dialog: "none" | "keys" | "bench";
  /** Reading size: lectures are read from the last row. */
  large: boolean;
}

/** Below this width three columns of panels are too narrow to read. */
const WIDE = 1280;

/** How this page looks at the bench; says nothing about the bench itself. */
export const useView = create<ViewStore>(() => ({
  layout: window.innerWidth >= WIDE ? "research" : "lab",
  card: "diagnosers.kalman",
  dialog: "none",
  large: false,
}));
