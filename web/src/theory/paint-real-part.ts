import type { PositiveReal } from "../api/types";
import { type Axis, linearAxis, logAxis, type Plot, paintAxes, type Range } from "../picture/axes";
import type { Box, Field, Look, Pen } from "../picture/pen";
import { fileStem, type Picture } from "../picture/picture";
import { paintLine, paintRule, within } from "../picture/traces";
import { formatShort } from "../ui/format";
import { CANVAS } from "../ui/palette";

/** Of the width, for the real part, where both plots have room beside one another. */
const FIRST = 0.58;
const forbidden = (alarm: string) => `${alarm}1c`;

/** Re G(jw) over frequency; the part below zero is marked. */
export function paintOverFrequency(pen: Pen, box: Box, { frequency, real }: PositiveReal, look: Look): void {
  const points = pairs(frequency, real);
  const ends: Range = [Math.min(...points.x), Math.max(...points.x)];
  const across = logAxis(ends, "ω, rad per unit of time", (value) => formatShort(value, ""));
  paintCurve(pen, box, points, across, linearAxis(around(points.y), "Re G(jω)"), look, ({ field, y }) => ({
    ...field,
    top: Math.min(field.bottom, Math.max(field.top, y(0))),
  }));
}

/** The imaginary part of G(jw) over the real one. */
export function paintNyquist(pen: Pen, box: Box, { real, imaginary }: PositiveReal, look: Look): void {
  const points = pairs(real, imaginary);
  const across = linearAxis(around(points.x), "Re G(jω)");
  paintCurve(pen, box, points, across, linearAxis(around(points.y), "Im G(jω)"), look, ({ field, x }) => ({
    ...field,
    right: Math.min(field.right, Math.max(field.left, x(0))),
  }));
}

/** The real part of a transfer function and its curve of Nyquist as a picture. */
export function realPartPicture(found: PositiveReal, text: string): Picture {
  const { accent, alarm } = CANVAS.light;
  return {
    title: `G(s) = ${text}`,
    stem: fileStem(`real-part-${text}`),
    legend: [
      { name: "G(jω)", colour: accent },
      { name: "negative real part", colour: forbidden(alarm), mark: "field" },
    ],
    height: 290,
    paint(pen, { width, height }, look) {
      paintOverFrequency(pen, { width: FIRST * width, height }, found, look);
      pen.save();
      pen.translate(FIRST * width, 0);
      paintNyquist(pen, { width: (1 - FIRST) * width, height }, found, look);
      pen.restore();
    },
  };
}

function paintCurve(
  pen: Pen,
  box: Box,
  points: { x: number[]; y: number[] },
  x: Axis,
  y: Axis,
  look: Look,
  negative: (plot: Plot) => Field,
): void {
  const ink = CANVAS[look.scheme];
  const plot = paintAxes(pen, box, x, y, look);
  const { left, right, top, bottom } = plot.field;
  within(pen, plot.field, () => {
    const field = negative(plot);
    pen.fillStyle = forbidden(ink.alarm);
    pen.fillRect(field.left, field.top, field.right - field.left, field.bottom - field.top);
    const zero = { colour: ink.event, width: 1 };
    paintRule(pen, [left, plot.y(0)], [right, plot.y(0)], zero);
    if (!x.isLog) paintRule(pen, [plot.x(0), top], [plot.x(0), bottom], zero);
    paintLine(pen, plot, points.x, points.y, { colour: ink.accent });
  });
}

/** Points with both numbers known. */
function pairs(x: readonly (number | null)[], y: readonly (number | null)[]): { x: number[]; y: number[] } {
  const known = x.flatMap((value, i) => {
    const other = y[i];
    return value === null || other === null ? [] : [[value, other] as const];
  });
  return { x: known.map(([value]) => value), y: known.map(([, value]) => value) };
}

/** The middle of the values with zero and some air: a pole on the axis must not flatten everything else. */
function around(values: number[]): Range {
  const sorted = [...values].sort((a, b) => a - b);
  const at = (share: number) => sorted[Math.round(share * (sorted.length - 1))] ?? 0;
  const spread = Math.max(at(0.95) - at(0.05), 1e-9);
  const low = Math.min(0, Math.max(sorted[0] ?? 0, at(0.05) - 2 * spread));
  const high = Math.max(0, Math.min(sorted.at(-1) ?? 0, at(0.95) + 2 * spread));
  const air = 0.06 * Math.max(high - low, 1e-9);
  return [low - air, high + air];
}
