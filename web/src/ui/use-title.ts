import { useEffect } from "react";

/** Name the window after what it shows, the smallest first. */
export function useTitle(...parts: (string | undefined)[]): void {
  const title = [...parts.filter(Boolean), "CombBench"].join(" | ");
  useEffect(() => {
    document.title = title;
  }, [title]);
}
