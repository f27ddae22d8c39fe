import { type TickedRange, type TickRoom, tickedRange } from "../../picture/ticked-range";

/** A vertical range that grows at once and shrinks only when it has been too wide for a while. */
export interface AxisRange extends TickedRange {
  /** Since when the data would fit a much smaller range, ms; undefined while they would not. */
  looseSince: number | undefined;
}

const LOOSE = 0.55;
export const SHRINK_AFTER_MS = 1200;
/** Least ratio of a range to the values in it. */
const AIR = 1.06;
const ROOM: TickRoom = { most: 8 };

export function nextRange(
  now: AxisRange | undefined,
  low: number,
  high: number,
  timeMs: number,
  room = ROOM,
): AxisRange {
  if (!(low <= high)) return now ?? { min: -1, max: 1, step: 1, looseSince: undefined };
  const fit = roundRange(low, high, room);
  if (!now) return { ...fit, looseSince: undefined };
  const [from, to] = withAir(low, high);
  const grows = from < now.min || to > now.max;
  const range = grows ? tickedRange(Math.min(from, now.min), Math.max(to, now.max), room) : now;
  const isLoose = fit.max - fit.min <= LOOSE * (range.max - range.min);
  const looseSince = isLoose ? ((grows ? undefined : now.looseSince) ?? timeMs) : undefined;
  if (looseSince !== undefined && timeMs - looseSince >= SHRINK_AFTER_MS) return { ...fit, looseSince: undefined };
  return !grows && looseSince === now.looseSince ? now : { ...range, looseSince };
}

/** A range in round steps, with a tick clear of either end of the values. */
export const roundRange = (low: number, high: number, room = ROOM): TickedRange =>
  tickedRange(...withAir(low, high), room);

/** The values with a little air beyond both ends; a flat line gets air around it. */
function withAir(low: number, high: number): [number, number] {
  const middle = (low + high) / 2;
  const least = Math.max(Math.abs(middle) * 1e-3, 1e-12);
  const half = Math.max((high - low) / 2, high - low < least ? Math.max(Math.abs(middle) * 0.2, 1e-3) : 0) * AIR;
  return [middle - half, middle + half];
}
