/** Two ends of an axis. */
export type Range = [number, number];

const AIR = 0.08;
const SHRINK = 0.02;

/** Smallest and largest of the finite values, or undefined when there are none. */
export function extent(values: ArrayLike<number>): Range | undefined {
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < values.length; i += 1) {
    const value = values[i];
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : undefined;
}

/** An axis around a range of values: it grows at once and shrinks slowly, so that the picture is steady. */
export function follow(before: Range | undefined, seen: Range): Range {
  const half = Math.max((seen[1] - seen[0]) / 2, 1e-9);
  const middle = (seen[0] + seen[1]) / 2;
  const wanted: Range = [middle - half * (1 + AIR), middle + half * (1 + AIR)];
  if (!before) return wanted;
  const low = seen[0] < before[0] ? wanted[0] : before[0] + SHRINK * (wanted[0] - before[0]);
  const high = seen[1] > before[1] ? wanted[1] : before[1] + SHRINK * (wanted[1] - before[1]);
  return [low, high];
}

/** Both ranges in one. */
export function union(a: Range, b: Range | undefined): Range {
  return b ? [Math.min(a[0], b[0]), Math.max(a[1], b[1])] : a;
}
