import { labelsOn, tickLabels } from "../ui/format";
import { CANVAS, fontFor } from "../ui/palette";
import { linearTicks, powerTicks } from "../ui/ticks";
import { timeLabels, timeUnit } from "../ui/time-axis";
import type { UnitScale } from "../ui/unit-scale";
import type { Box, Field, Look, Pen } from "./pen";
import { type TickedRange, ticksOf } from "./ticked-range";

export type Range = readonly [number, number];
export type Place = (value: number) => number;

/** One axis of a plot: its ends, its ticks and their labels. */
export interface Axis {
  range: Range;
  isLog?: boolean;
  /** Along the axis, with the unit; undefined where it is written elsewhere. */
  title?: string;
  /** Without a title: the unit of the numbers, at their foot. */
  unit?: string;
  /** About so many. */
  ticks(count: number): readonly number[];
  /** Nothing where another plot below says it. */
  say(ticks: readonly number[]): readonly string[];
}

/** The field of a plot, and the places of its values. */
export interface Plot {
  field: Field;
  x: Place;
  y: Place;
}

/** An axis of one scale from end to end; on a scale of units its ticks are round in the unit shown. */
export function linearAxis(range: Range, title?: string, scale?: Pick<UnitScale, "factor" | "exponent">): Axis {
  const factor = scale?.factor ?? 1;
  return {
    range,
    title,
    ticks(count) {
      const [low, high] = this.range.map((end) => end * factor);
      const ticks = linearTicks(low, high, Math.max(2, count));
      // one number alone is no scale; a request for 5 gives at least two in any range
      return (ticks.length > 1 ? ticks : linearTicks(low, high, 5)).map((t) => t / factor);
    },
    say: scale ? (ticks) => labelsOn(scale, ticks) : tickLabels,
  };
}

/** An axis that ends with ticks. */
export const tickedAxis = (range: TickedRange, scale: UnitScale): Axis => ({
  ...linearAxis([range.min, range.max], undefined, scale),
  ticks: () => ticksOf(range),
});

/** A logarithmic axis with a tick at each power of ten, or at the ticks given. */
export function logAxis(
  range: Range,
  title: string | undefined,
  write: (value: number) => string,
  ticks = powerTicks(...range),
): Axis {
  return { range, isLog: true, title, ticks: () => ticks, say: (shown) => shown.map(write) };
}

/** An axis of device time over ticks; its zero may differ from tick 0. */
export function timeAxis({ start, end }: { start: number; end: number }, dtMs: number, origin = 0): Axis {
  const span = (end - start) * dtMs;
  const first = (start - origin) * dtMs;
  return {
    range: [start, end],
    unit: timeUnit(span).unit,
    ticks: (count) => linearTicks(first, first + span, Math.max(2, count)).map((ms) => ms / dtMs + origin),
    say: (ticks) =>
      timeLabels(
        ticks.map((tick) => (tick - origin) * dtMs),
        span,
      ),
  };
}

/** The places of the values of an axis between two pixels. */
export function placeOn({ range: [low, high], isLog }: Pick<Axis, "range" | "isLog">, from: number, to: number): Place {
  if (!isLog) return (value) => from + ((value - low) / (high - low)) * (to - from);
  const decades = Math.log(high / low);
  return (value) => from + (Math.log(Math.max(value, Number.MIN_VALUE) / low) / decades) * (to - from);
}

/** Room above a field and right of it, px. */
const TOP = 8;
const RIGHT = 14;
/** Between a field and its numbers, px. */
const GAP = 6;

interface AxesOptions {
  /** The field is square and in the middle. */
  isSquare?: boolean;
  /** One unit across is as long as one unit up: the axis with more room reaches further. */
  isAlike?: boolean;
  /** Room for the numbers of the upright axis, px, if several plots share one column. */
  gutter?: number;
}

/** Two axes with grid, numbers and titles; the field between them stays empty. */
export function paintAxes(pen: Pen, box: Box, across: Axis, up: Axis, look: Look, options: AxesOptions = {}): Plot {
  let [x, y] = [across, up];
  const { fontSize } = look;
  const row = Math.round(fontSize * 1.45);
  pen.font = fontFor(fontSize, 1);
  const hasNumbers = x.say(x.ticks(2)).length > 0;
  const bottom = box.height - (hasNumbers ? row + 2 : Math.round(fontSize * 0.6)) - (x.title ? row : 0);
  const rows = y.ticks(rowCount(bottom - TOP, fontSize));
  const widest = options.gutter ?? Math.max(fontSize * 2, ...y.say(rows).map((text) => pen.measureText(text).width));
  const left = Math.ceil((y.title ? row : 2) + widest + GAP);
  const whole = { left, right: Math.max(left + 20, box.width - RIGHT), top: TOP, bottom: Math.max(TOP + 20, bottom) };
  const field = options.isSquare ? squareWithin(whole) : whole;
  if (options.isAlike) {
    const unit = Math.max(lengthOf(x) / (field.right - field.left), lengthOf(y) / (field.bottom - field.top));
    x = about(x, unit * (field.right - field.left));
    y = about(y, unit * (field.bottom - field.top));
  }
  const plot = { field, x: placeOn(x, field.left, field.right), y: placeOn(y, field.bottom, field.top) };
  paintColumns(pen, field, x, look);
  paintRows(pen, field, y, look);
  paintFrame(pen, field, look);
  pen.fillStyle = CANVAS[look.scheme].text;
  pen.font = fontFor(fontSize, 1, 500);
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  if (x.title) pen.fillText(x.title, (field.left + field.right) / 2, field.bottom + row * 1.5 + 2, box.width - 2 * GAP);
  if (y.title) {
    pen.save();
    pen.translate(field.left - widest - GAP - row / 2, (field.top + field.bottom) / 2);
    pen.rotate(-Math.PI / 2);
    const room = field.bottom - field.top + (box.height - bottom);
    pen.fillText(titleIn(pen, y.title, room), 0, 0, room);
    pen.restore();
  }
  return plot;
}

/** A title, or its unit where the whole would be squeezed. */
function titleIn(pen: Pen, title: string, room: number): string {
  return pen.measureText(title).width > room ? (title.split(", ").at(-1) ?? title) : title;
}

/** How many numbers fit above one another. */
const rowCount = (tall: number, fontSize: number) => Math.min(8, tall / (fontSize * 1.9));

const lengthOf = ({ range: [low, high] }: Axis) => high - low;

/** An axis of another length about the same middle. */
function about(axis: Axis, length: number): Axis {
  const middle = (axis.range[0] + axis.range[1]) / 2;
  return { ...axis, range: [middle - length / 2, middle + length / 2] };
}

/**
 * The grid and the numbers of an axis across, under a field; a number without room is left out.
 *
 * The room ends at other text or at the edge of the picture.
 */
export function paintColumns(
  pen: Pen,
  { left, right, top, bottom }: Field,
  axis: Axis,
  look: Look,
  room: Range = [Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY],
): void {
  const { fontSize } = look;
  const ink = CANVAS[look.scheme];
  const place = placeOn(axis, left, right);
  const ticks = axis.ticks((right - left) / (fontSize * 5));
  const labels = axis.say(ticks);
  const middle = bottom + 2 + fontSize * 0.75;
  pen.font = fontFor(fontSize, 1);
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  let free = room[0];
  ticks.forEach((tick, i) => {
    const at = place(tick);
    pen.fillStyle = ink.grid;
    pen.fillRect(Math.round(at), top, 1, bottom - top);
    if (labels[i] === undefined) return;
    const half = pen.measureText(labels[i]).width / 2;
    if (at - half < free || at + half > room[1]) return;
    free = at + half + fontSize * 0.7;
    pen.fillStyle = ink.muted;
    pen.fillText(labels[i], at, middle);
  });
  if (!axis.unit) return;
  pen.textAlign = "right";
  pen.font = fontFor(fontSize, 1, 600);
  pen.fillStyle = ink.muted;
  pen.fillText(axis.unit, left - fontSize * 2.2, middle);
}

/** The numbers of an upright axis beside a field, and its grid if the numbers are on the left. */
export function paintRows(pen: Pen, field: Field, axis: Axis, look: Look, rightOf?: number): void {
  const { fontSize } = look;
  const ink = CANVAS[look.scheme];
  const place = placeOn(axis, field.bottom, field.top);
  const ticks = axis.ticks(rowCount(field.bottom - field.top, fontSize));
  pen.font = fontFor(fontSize, 1);
  pen.textBaseline = "middle";
  pen.textAlign = rightOf === undefined ? "right" : "left";
  const beside = rightOf === undefined ? field.left - GAP : rightOf + GAP;
  let free = Number.POSITIVE_INFINITY;
  axis.say(ticks).forEach((label, i) => {
    const at = place(ticks[i]);
    if (rightOf === undefined) {
      pen.fillStyle = ink.grid;
      pen.fillRect(field.left, Math.round(at), field.right - field.left, 1);
    }
    if (at > free) return;
    free = at - fontSize * 1.15;
    pen.fillStyle = ink.muted;
    pen.fillText(label, beside, at);
  });
}

/** The two lines of the axes. */
export function paintFrame(pen: Pen, { left, right, top, bottom }: Field, { scheme }: Look): void {
  pen.fillStyle = CANVAS[scheme].axis;
  pen.fillRect(Math.round(left), top, 1, bottom - top);
  pen.fillRect(left, Math.round(bottom), right - left, 1);
}

/** The largest square in the middle of a field. */
export function squareWithin({ left, right, top, bottom }: Field): Field {
  const side = Math.max(0, Math.floor(Math.min(right - left, bottom - top)));
  const from = { x: Math.round(left + (right - left - side) / 2), y: Math.round(top + (bottom - top - side) / 2) };
  return { left: from.x, right: from.x + side, top: from.y, bottom: from.y + side };
}
