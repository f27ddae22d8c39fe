import type { Pen } from "../../picture/pen";
import type { BarRaster } from "./bar-raster";

/** The least and the most of a signal in each column; NaN where it has no data. */
export type Envelope = { low: Float32Array; high: Float32Array };

/** The place of a trace: the field in pixels of the pen, and the time and the values at its edges. */
export interface TraceField {
  left: number;
  top: number;
  width: number;
  height: number;
  from: number;
  to: number;
  min: number;
  max: number;
}

interface TraceInk {
  colour: string;
  /** px of the pen, as are the dashes. */
  width: number;
  dashes: readonly number[];
  /** The columns hold so few samples that the trace is a line, however close they are. */
  isLine?: boolean;
}

/** Columns closer than this, px, are drawn as bars that meet; those further apart are joined by a line. */
const CLOSE = 1.3;

/**
 * Paint min/max columns: a bar for each column, from its least to its largest value and on to the bar before.
 *
 * Bars are rectangles and no path: eight scopes of six fast traces are drawn in a tenth of the time that a stroke takes
 * where no graphics card helps. A spike of one tick is a bar of its full height, dashes or not, so it cannot be missed.
 * `pen` draws the lines that join columns, `bars` the bars, on the screen straight into pixels. Bars have no slanted edge,
 * so columns of few samples, which are a line to the eye, are joined by one too.
 */
export function paintEnvelope(
  pen: Pen,
  bars: Pick<BarRaster, "fillStyle" | "fillRect">,
  times: ArrayLike<number>,
  { low, high }: Envelope,
  field: TraceField,
  ink: TraceInk,
): void {
  const { left, top, width, height, from, to, min, max } = field;
  const perTime = width / (to - from);
  const perValue = height / (max - min);
  const bottom = top + height;
  const zero = bottom + min * perValue;
  const step = (perTime * (times[times.length - 1] - times[0])) / (times.length - 1);
  // as wide as a column and no wider: time grows with the filled area
  const bar = Math.max(1, Math.ceil(Math.min(CLOSE, step)));
  const half = ink.width / 2;
  const isInk = dashing(ink.dashes);
  pen.save();
  bars.fillStyle = pen.strokeStyle = ink.colour;
  pen.lineWidth = ink.width;
  pen.lineJoin = "round";
  pen.setLineDash([...ink.dashes]);
  pen.beginPath();
  const before = { x: Number.NaN, high: 0, low: 0 };
  let y = 0; // the end of the line so far
  let drawing = false;
  let hasLines = false;
  for (let c = 0; c < times.length; c += 1) {
    if (Number.isNaN(low[c])) continue;
    const x = left + (times[c] - from) * perTime;
    const yHigh = clamp(zero - high[c] * perValue, top, bottom);
    const yLow = clamp(zero - low[c] * perValue, top, bottom);
    const meets = !ink.isLine && x - before.x <= CLOSE;
    if (meets && isInk(x - left)) {
      const head = Math.min(yHigh, before.low) - half;
      bars.fillRect(Math.round(x - bar / 2), head, bar, Math.max(yLow, before.high) + half - head);
    } else if (standsOut(low, high, c) && yLow - yHigh > 1) {
      bars.fillRect(Math.round(x - bar / 2), yHigh, bar, yLow - yHigh);
    }
    const isJoined = !meets && !Number.isNaN(before.x);
    if (isJoined) {
      if (!drawing) pen.moveTo(before.x, y);
      // both ends of a column, the nearer one first, as a signal goes that rises or falls
      const [near, far] = Math.abs(yLow - y) < Math.abs(yHigh - y) ? [yLow, yHigh] : [yHigh, yLow];
      const apart = far === near ? 0 : step / 4;
      pen.lineTo(x - apart, near);
      if (apart) pen.lineTo(x + apart, far);
      y = far;
      hasLines = true;
    } else y = (yLow + yHigh) / 2;
    drawing = isJoined;
    before.x = x;
    before.high = yHigh;
    before.low = yLow;
  }
  if (hasLines) pen.stroke();
  pen.restore();
}

const clamp = (y: number, top: number, bottom: number) => (y < top ? top : y > bottom ? bottom : y);

/** Whether a column covers far more than its neighbours: a spike, which the gap of a dashed line must not hide. */
function standsOut(low: Float32Array, high: Float32Array, column: number): boolean {
  const span = (c: number) => (c in low && !Number.isNaN(low[c]) ? high[c] - low[c] : 0);
  return span(column) > 2 * Math.max(span(column - 1), span(column + 1));
}

/** Whether a dashed line has ink at a place along it. */
function dashing(dashes: readonly number[]): (x: number) => boolean {
  const period = dashes.reduce((sum, dash) => sum + dash, 0);
  if (!period) return () => true;
  const inked: boolean[] = [];
  dashes.forEach((dash, i) => {
    for (let px = 0; px < dash; px += 1) inked.push(i % 2 === 0);
  });
  return (x) => inked[Math.floor(x % period)];
}

/** How strong the area between two traces is. */
const SHADE = 0.35;

/** Fill the area between two traces, where both have data. */
export function shadeBetween(
  pen: Pen,
  times: ArrayLike<number>,
  one: Envelope,
  other: Envelope,
  { left, top, width, height, from, to, min, max }: TraceField,
  colour: string,
): void {
  const x = (c: number) => left + ((times[c] - from) * width) / (to - from);
  const y = ({ low, high }: Envelope, c: number) =>
    clamp(top + height - (0.5 * (low[c] + high[c]) - min) * (height / (max - min)), top, top + height);
  pen.save();
  pen.globalAlpha = SHADE;
  pen.fillStyle = colour;
  for (let start = 0; start < times.length; start += 1) {
    let end = start;
    while (end < times.length && Number.isFinite(one.low[end] + other.low[end])) end += 1;
    if (end - start < 2) continue;
    pen.beginPath();
    pen.moveTo(x(start), y(one, start));
    for (let c = start + 1; c < end; c += 1) pen.lineTo(x(c), y(one, c));
    for (let c = end - 1; c >= start; c -= 1) pen.lineTo(x(c), y(other, c));
    pen.fill();
    start = end;
  }
  pen.restore();
}

/** The difference of two traces, sample by sample; no data where columns hold several samples. */
export function differenceOf(one: Envelope, other: Envelope, isSampled: boolean): Envelope {
  const less = one.low.map((value, c) => (isSampled ? value - other.low[c] : Number.NaN));
  return { low: less, high: less };
}

/** The decimal logarithms of magnitudes; minus infinity where a column holds 0. */
export function magnitudesOf({ low, high }: Envelope): Envelope {
  const least = low.map((value, c) => (value > 0 ? value : high[c] < 0 ? -high[c] : 0 * value));
  const most = low.map((value, c) => Math.max(-value, high[c]));
  return { low: least.map(Math.log10), high: most.map(Math.log10) };
}
