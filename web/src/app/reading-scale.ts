import type { LayoutName } from "../bench/view-store";

/** The window for which the sizes of a lecture are made; those of a larger one grow with it. */
const MADE_FOR = { width: 1366, height: 768 };
const MOST = 3;

/** How large letters are in a layout, as a factor on those of its usual window. */
export function readingScale(layout: LayoutName, width: number, height: number): number {
  if (layout !== "lecture") return 1;
  return Math.min(MOST, Math.max(1, Math.min(width / MADE_FOR.width, height / MADE_FOR.height)));
}
