import { useCallback, useMemo } from "react";
import { openPlace, useView } from "../bench/view-store";

/** A run, a campaign, or several runs side by side, whose ids are separated by commas. */
export interface Chosen {
  kind?: "run" | "campaign" | "comparison";
  id: string;
}

/** Which run or campaign the page shows; the address names it. */
export function useChosen(): [Chosen | undefined, (next: Chosen | undefined) => void] {
  const id = useView((s) => s.item);
  const chosen = useMemo((): Chosen | undefined => {
    if (!id) return undefined;
    return id.includes(",") ? { kind: "comparison", id } : { id };
  }, [id]);
  const choose = useCallback((next: Chosen | undefined) => openPlace("runs", next?.id), []);
  return [chosen, choose];
}
