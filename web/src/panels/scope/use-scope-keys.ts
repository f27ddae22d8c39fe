import { type KeyboardEvent, type RefObject, useCallback } from "react";
import type { ScopePlot } from "./scope-plot";
import { zoomSpan } from "./use-time-view";

/** Arrow keys pan, plus and minus zoom, L goes live, page keys go through captures. */
export function useScopeKeys(
  plot: RefObject<ScopePlot | undefined>,
  look: (start: number, end: number) => void,
  goLive: () => void,
  browse: (by: number) => void,
) {
  return useCallback(
    (event: KeyboardEvent) => {
      const now = plot.current?.span;
      if (!now || event.ctrlKey || event.metaKey || event.altKey) return;
      const width = now.end - now.start;
      const middle = (now.start + now.end) / 2;
      if (event.key === "ArrowLeft") look(now.start - width / 8, now.end - width / 8);
      else if (event.key === "ArrowRight") look(now.start + width / 8, now.end + width / 8);
      else if (event.key === "+" || event.key === "=") zoom(0.7);
      else if (event.key === "-") zoom(1 / 0.7);
      else if (event.key === "l" || event.key === "L") goLive();
      else if (event.key === "PageUp") browse(-1);
      else if (event.key === "PageDown") browse(1);
      else if (event.key === "End") browse(Number.POSITIVE_INFINITY);
      else return;
      event.preventDefault();
      event.stopPropagation();

      function zoom(factor: number) {
        if (!now) return;
        const next = zoomSpan(now.start, now.end, middle, factor);
        look(next.start, next.end);
      }
    },
    [plot, look, goLive, browse],
  );
}
