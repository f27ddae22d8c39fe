/** Ticks of a bucket of the history, and of a bucket of these. */
const BUCKETS = [256, 16];
/** Buckets that a column has at least; fewer would cost more of the columns. */
const LEAST = 4;

/** The ticks that the columns of a picture cover, each the same number of them. */
export interface TickSpan {
  start: number;
  end: number;
  columns: number;
}

/** The ticks of one column, so that `width` columns cover `ticks`; of wide columns whole buckets of the history. */
export function columnStep(ticks: number, width: number): number {
  const step = Math.max(1, Math.ceil(ticks / width));
  const bucket = BUCKETS.find((one) => step >= LEAST * one) ?? 1;
  return Math.ceil(step / bucket) * bucket;
}

/** The columns that end with the newest tick. */
export function spanEnding(head: number, window: number, width: number): TickSpan {
  const step = columnStep(window, width);
  const columns = Math.max(1, Math.ceil(window / step));
  const end = Math.ceil(head / step) * step;
  return { start: end - columns * step, end, columns };
}

/** The columns that cover at least some ticks. */
export function spanBetween(start: number, end: number, width: number): TickSpan {
  const step = columnStep(end - start, width);
  const first = Math.floor(start / step) * step;
  const columns = Math.max(1, Math.ceil((end - first) / step));
  return { start: first, end: first + columns * step, columns };
}

/** The columns of a window that begins at a tick. */
export function spanFrom(start: number, window: number, width: number): TickSpan {
  const step = columnStep(window, width);
  const columns = Math.max(1, Math.ceil(window / step));
  return { start, end: start + columns * step, columns };
}
