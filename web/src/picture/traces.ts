import type { Place, Plot } from "./axes";
import type { Field, Pen } from "./pen";

interface Stroke {
  colour: string;
  width?: number;
  dashes?: readonly number[];
  alpha?: number;
}

/** Paint within a field alone. */
export function within(pen: Pen, { left, right, top, bottom }: Field, paint: () => void): void {
  pen.save();
  pen.beginPath();
  pen.rect(left, top, right - left, bottom - top);
  pen.clip();
  paint();
  pen.restore();
}

/** A line through points; where there is none it is interrupted. */
export function paintLine(
  pen: Pen,
  { x, y }: Pick<Plot, "x" | "y">,
  across: ArrayLike<number>,
  up: ArrayLike<number>,
  stroke: Stroke,
  isStepped = false,
): void {
  pen.beginPath();
  let before: number | undefined;
  for (let i = 0; i < across.length; i += 1) {
    if (!Number.isFinite(across[i] + up[i])) {
      before = undefined;
      continue;
    }
    const [atX, atY] = [x(across[i]), y(up[i])];
    if (before === undefined) pen.moveTo(atX, atY);
    else {
      if (isStepped) pen.lineTo(atX, before);
      pen.lineTo(atX, atY);
    }
    before = atY;
  }
  ink(pen, stroke);
}

/** A straight line between two points of the picture, px. */
export function paintRule(pen: Pen, from: readonly [number, number], to: readonly [number, number], stroke: Stroke) {
  pen.beginPath();
  pen.moveTo(...from);
  pen.lineTo(...to);
  ink(pen, stroke);
}

/** The area between two lines over the same points. */
export function paintBand(
  pen: Pen,
  { x, y }: Pick<Plot, "x" | "y">,
  across: readonly number[],
  low: readonly number[],
  high: readonly number[],
  colour: string,
): void {
  pen.fillStyle = colour;
  pen.beginPath();
  across.forEach((at, i) => {
    pen.lineTo(x(at), y(high[i]));
  });
  for (let i = across.length - 1; i >= 0; i -= 1) pen.lineTo(x(across[i]), y(low[i]));
  pen.closePath();
  pen.fill();
}

/** Heights of steps are rounded to a share of a pixel that no eye sees: equal neighbours are one step. */
const STEPS_PER_PX = 4;

/** Fill below steps, one for each column; a column without a value belongs to the step before it. */
export function fillSteps(
  pen: Pen,
  values: Float32Array,
  columnX: (column: number) => number,
  base: number,
  heightOf: (value: number) => number,
): void {
  // One outline: a rectangle for each column takes software that draws without a graphics card many times longer.
  const right = columnX(values.length);
  let y: number | undefined;
  pen.beginPath();
  values.forEach((value, c) => {
    if (Number.isNaN(value)) return;
    const next = base - Math.round(heightOf(value) * STEPS_PER_PX) / STEPS_PER_PX;
    if (next === y) return;
    if (y === undefined) pen.moveTo(columnX(c), base);
    else pen.lineTo(columnX(c), y);
    pen.lineTo(columnX(c), next);
    y = next;
  });
  if (y === undefined) return;
  pen.lineTo(right, y);
  pen.lineTo(right, base);
  pen.fill();
}

/** A dot at a point, px. */
export function paintDot(pen: Pen, x: number, y: number, radius: number, colour: string): void {
  if (!Number.isFinite(x + y)) return;
  pen.fillStyle = colour;
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.fill();
}

/** Half of a cross, px. */
export const CROSS = 7;

/** A cross at a point, px. */
export function paintCross(pen: Pen, x: number, y: number, stroke: Stroke): void {
  pen.beginPath();
  for (const rise of [CROSS, -CROSS]) {
    pen.moveTo(x - CROSS, y - rise);
    pen.lineTo(x + CROSS, y + rise);
  }
  ink(pen, stroke);
}

/** Points with error bars. */
export function paintPoints(
  pen: Pen,
  plot: Pick<Plot, "x" | "y">,
  across: readonly number[],
  up: readonly number[],
  colour: string,
  errors?: readonly number[],
): void {
  across.forEach((value, i) => {
    const at = plot.x(value);
    const half = errors?.[i] ?? 0;
    if (half > 0) paintRule(pen, [at, plot.y(up[i] - half)], [at, plot.y(up[i] + half)], { colour, width: 1 });
    paintDot(pen, at, plot.y(up[i]), 3, colour);
  });
}

/**
 * Columns of minima and maxima: a bar wherever a column spans more than a line is thick, and a line through the middles.
 * A spike of one tick is a bar, so it can never be missed; columns without data are bridged.
 */
export function strokeEnvelope(
  pen: Pen,
  { x, y }: { x: Place; y: Place },
  { low, high }: { low: Float32Array; high: Float32Array },
  stroke: Stroke,
): void {
  const bars = { ...stroke, width: (stroke.width ?? 2) * 0.7, dashes: undefined };
  pen.beginPath();
  let hasBars = false;
  low.forEach((value, c) => {
    if (!(y(value) - y(high[c]) > 1)) return;
    pen.moveTo(x(c), y(value));
    pen.lineTo(x(c), y(high[c]));
    hasBars = true;
  });
  if (hasBars) ink(pen, bars);
  pen.beginPath();
  let isDrawing = false;
  low.forEach((value, c) => {
    if (Number.isNaN(value)) return;
    const middle = (y(value) + y(high[c])) / 2;
    if (isDrawing) pen.lineTo(x(c), middle);
    else pen.moveTo(x(c), middle);
    isDrawing = true;
  });
  ink(pen, stroke);
}

/** Stroke the path that was begun. */
function ink(pen: Pen, { colour, width = 2, dashes = [], alpha = 1 }: Stroke): void {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.lineJoin = "round";
  pen.globalAlpha = alpha;
  pen.setLineDash([...dashes]);
  pen.stroke();
  pen.setLineDash([]);
  pen.globalAlpha = 1;
}

const STEP = 8;

/** Fill a field with the diagonal hatch of a colour: hatched is a guess, solid is known. */
export function fillHatched(pen: Pen, left: number, top: number, width: number, height: number, colour: string): void {
  pen.fillStyle = `${colour}40`;
  pen.fillRect(left, top, width, height);
  pen.strokeStyle = colour;
  pen.lineWidth = 2.4;
  pen.beginPath();
  const right = left + width;
  const bottom = top + height;
  // lines of one x + y each, so that the hatches of neighbours meet
  for (let sum = Math.ceil((left + top) / STEP) * STEP; sum < right + bottom; sum += STEP) {
    const from = Math.max(left, sum - bottom);
    const to = Math.min(right, sum - top);
    pen.moveTo(from, sum - from);
    pen.lineTo(to, sum - to);
  }
  pen.stroke();
}
