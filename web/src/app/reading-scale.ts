/** The window for which the sizes of a lecture are made; those of a larger one grow with it. */
const MADE_FOR = { width: 1366, height: 768 };
const MOST = 3;

/** How large letters of large type are, as a factor on those of the window it is made for. */
export function readingScale(large: boolean, width: number, height: number): number {
  if (!large) return 1;
  return Math.min(MOST, Math.max(1, Math.min(width / MADE_FOR.width, height / MADE_FOR.height)));
}
