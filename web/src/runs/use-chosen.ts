import { useCallback, useEffect, useState } from "react";

/** A run, a campaign, or several runs side by side, whose ids are separated by commas. */
export interface Chosen {
  kind: "run" | "campaign" | "comparison";
  id: string;
}

/** What the address calls each. */
const KEYS: Record<Chosen["kind"], string> = { comparison: "compare", campaign: "sweep", run: "run" };
const KINDS = Object.keys(KEYS) as Chosen["kind"][];

function inAddress(): Chosen | undefined {
  const query = new URLSearchParams(window.location.search);
  const kind = KINDS.find((one) => query.get(KEYS[one]));
  return kind && { kind, id: query.get(KEYS[kind]) ?? "" };
}

/** Which run or campaign the page shows; the address names it. */
export function useChosen(): [Chosen | undefined, (next: Chosen | undefined) => void] {
  const [chosen, setChosen] = useState(inAddress);
  useEffect(() => {
    const back = () => setChosen(inAddress());
    window.addEventListener("popstate", back);
    return () => window.removeEventListener("popstate", back);
  }, []);
  const choose = useCallback((next: Chosen | undefined) => {
    const url = new URL(window.location.href);
    for (const kind of KINDS) url.searchParams.delete(KEYS[kind]);
    if (next) url.searchParams.set(KEYS[next.kind], next.id);
    window.history.pushState(null, "", url);
    setChosen(next);
  }, []);
  return [chosen, choose];
}
