import { useEffect } from "react";
import { create } from "zustand";
import { api } from "../api/api";
import { useAnswer } from "../api/queries";
import { storageName } from "../api/storage-name";
import type { PrintedMark } from "../api/types";
import { useBench } from "../stream/bench-store";

const KEPT = storageName("combbench.printed");

interface PrintedStore {
  /** The printed marks of the figure of the bench on the page. */
  marks: PrintedMark[];
  /** Whether scopes draw it. */
  isShown: boolean;
}

export const usePrinted = create<PrintedStore>(() => ({ marks: [], isShown: localStorage.getItem(KEPT) !== "off" }));

/** Draw the printed marks under the traces, or leave them out; the choice is kept for the next visit. */
export function showPrinted(isShown: boolean): void {
  localStorage.setItem(KEPT, isShown ? "on" : "off");
  usePrinted.setState({ isShown });
}

/** Kinds of events after which another run begins. */
const BEGINNINGS = ["reset", "restored", "opened"];

/** Names the run of the bench on the page: another after each beginning. */
export const useRun = (): readonly unknown[] | undefined => {
  const id = useBench((s) => s.bench?.id);
  const began = useBench((s) => s.events.findLast(({ kind }) => BEGINNINGS.includes(kind))?.seq);
  const isBlind = useBench((s) => s.blind);
  return id === undefined || isBlind ? undefined : [id, began];
};

/** Ask for the printed marks of the figure of the bench on the page; one answer for all scopes. */
export function useMarks(): PrintedMark[] {
  const run = useRun();
  const id = useBench((s) => s.bench?.id) ?? "";
  const { value } = useAnswer(run && ["printed", ...run], () => api.printed(id));
  const marks = run && value;
  useEffect(() => usePrinted.setState({ marks: marks ?? NONE }), [marks]);
  return marks ?? NONE;
}

const NONE: PrintedMark[] = [];

/** The marks that can be drawn over some signals. */
export const marksOver = (marks: readonly PrintedMark[], signals: readonly string[]): PrintedMark[] =>
  marks.filter(({ signal, problem }) => problem === "" && signals.includes(signal));

/** Where a mark is printed: "figure 3.1.3.2.2, section 3.1.3.2". */
export const placeIn = ({ figure, section }: Pick<PrintedMark, "figure" | "section">): string =>
  figure ? `figure ${figure}, section ${section}` : `section ${section}`;
