import { roundTo } from "../ui/unit-scale";

/** A range that ends with ticks, in one step from each to the next. */
export interface TickedRange {
  min: number;
  max: number;
  step: number;
}

/** Room for the ticks of an upright axis. */
export interface TickRoom {
  /** Steps between the ends, at least two. */
  most: number;
  /** The finest step, such as a whole decade. */
  finest?: number;
}

/** Between two numbers over one another, in sizes of the letters. */
const ROW = 1.4;

/** The room for ticks on an axis of so many px. */
export const tickRoom = (tall: number, fontSize: number): TickRoom => ({
  most: Math.max(2, Math.min(8, Math.floor(tall / (fontSize * ROW)))),
});

/** The range of the finest round steps that have room, with a tick at or beyond either end of the values. */
export function tickedRange(low: number, high: number, { most, finest = 0 }: TickRoom): TickedRange {
  const ends = (step: number) => [Math.floor(low / step + 1e-9), Math.ceil(high / step - 1e-9)];
  let step = roundStep(Math.max((high - low) / most, finest));
  let [first, last] = ends(step);
  while (last - first > most) {
    step = roundStep(step * 1.5);
    [first, last] = ends(step);
  }
  return { min: roundTo(first * step, 12), max: roundTo(last * step, 12), step };
}

/** The next step of 1, 2 or 5 that is not smaller. */
function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return roundTo(power * ([1, 2, 5, 10].find((m) => m * power >= least * 0.9999) ?? 10), 12);
}

/** The ticks from end to end. */
export const ticksOf = ({ min, max, step }: TickedRange): number[] =>
  Array.from({ length: Math.round((max - min) / step) + 1 }, (_, i) =>
    roundTo((Math.round(min / step) + i) * step, 12),
  );
