import { linearTicks } from "../../ui/ticks";

/** Ends of a strip's axis: whole ticks around all that is seen, so that it moves seldom. */
export function stripRange(values: Iterable<number>): [number, number] {
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return [-1, 1];
  const middle = 0.5 * (low + high);
  const half = Math.max(0.5 * (high - low), Math.abs(middle) * 1e-3, 1e-30) * 1.15;
  const ticks = linearTicks(middle - 2 * half, middle + 2 * half, 16);
  return [
    ticks.filter((t) => t <= middle - half).at(-1) ?? middle - half,
    ticks.find((t) => t >= middle + half) ?? middle + half,
  ];
}
