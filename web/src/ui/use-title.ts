import { useEffect } from "react";

/** Set the title of the window: the parts from the smallest to the page. */
export function useTitle(...parts: (string | undefined)[]): void {
  const title = [...parts.filter(Boolean), "CombBench"].join(" | ");
  useEffect(() => {
    document.title = title;
  }, [title]);
}
