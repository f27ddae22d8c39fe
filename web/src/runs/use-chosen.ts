import { useCallback, useEffect, useState } from "react";

/** A run or a campaign. */
export interface Chosen {
  kind: "run" | "campaign";
  id: string;
}

function inAddress(): Chosen | undefined {
  const query = new URLSearchParams(window.location.search);
  const run = query.get("run");
  const sweep = query.get("sweep");
  return sweep ? { kind: "campaign", id: sweep } : run ? { kind: "run", id: run } : undefined;
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
    url.searchParams.delete("run");
    url.searchParams.delete("sweep");
    if (next) url.searchParams.set(next.kind === "run" ? "run" : "sweep", next.id);
    window.history.pushState(null, "", url);
    setChosen(next);
  }, []);
  return [chosen, choose];
}
