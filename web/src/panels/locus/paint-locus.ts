import { linearAxis, type Plot, paintAxes } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { paintDot, paintLine, paintRule, within } from "../../picture/traces";
import { formatIn, formatNumber } from "../../ui/format";
import { TRACE_COLOURS } from "../../ui/palette";
import type { UnitScale } from "../../ui/unit-scale";
import { roundTo } from "../../ui/unit-scale";
import type { LocusAxes, Points } from "./locus-axes";

interface LocusTrace {
  name: string;
  /** In `TRACE_COLOURS`. */
  slot: number;
  points: Points;
  /** Of its long axis; undefined while nothing moves. */
  tiltDeg: number | undefined;
}

export interface LocusShown {
  axes: LocusAxes;
  scales: { x: UnitScale; y: UnitScale };
  traces: readonly LocusTrace[];
}

/** The tilt in words. */
export const tiltText = (degrees: number | undefined) =>
  degrees === undefined ? "at rest" : formatIn(degrees, "°", Math.abs(degrees) < 10 ? 3 : 2);

/** By how much y is drawn larger than x, in one digit that does not flicker; nothing where both have one scale. */
function stretchText({ x, y }: LocusAxes): string {
  const stretch = (x[1] - x[0]) / (y[1] - y[0]);
  return stretch < 1.5 ? "" : ` (×${formatNumber(roundTo(stretch, 1), 0)})`;
}

/** The path of the mass in its plane, and the line along which it swings. */
export function paintLocus(pen: Pen, box: Box, { axes, scales, traces }: LocusShown, look: Look): void {
  const across = linearAxis(axes.x, `x, ${scales.x.unit}`, scales.x);
  const up = linearAxis(axes.y, `y, ${scales.y.unit}${stretchText(axes)}`, scales.y);
  const plot = paintAxes(pen, box, across, up, look, { isSquare: true, gutter: look.fontSize * 2.7 });
  within(pen, plot.field, () => {
    for (const trace of traces) {
      const colour = TRACE_COLOURS[look.scheme][trace.slot];
      paintLongAxis(pen, plot, trace, axes, colour);
      const { x, y } = trace.points;
      paintLine(pen, plot, x, y, { colour, width: 1.8 });
      const last = x.findLastIndex((value, i) => Number.isFinite(value + y[i]));
      if (last >= 0) paintDot(pen, plot.x(x[last]), plot.y(y[last]), 4.5, colour);
    }
  });
}

/** The long axis, from edge to edge. */
function paintLongAxis(pen: Pen, { x, y }: Plot, { tiltDeg }: LocusTrace, axes: LocusAxes, colour: string): void {
  if (tiltDeg === undefined) return;
  const reach = 2 * Math.max(axes.x[1], axes.y[1]);
  const turn = (tiltDeg * Math.PI) / 180;
  const [dx, dy] = [reach * Math.cos(turn), reach * Math.sin(turn)];
  paintRule(pen, [x(-dx), y(-dy)], [x(dx), y(dy)], { colour, width: 1, dashes: [7, 4], alpha: 0.7 });
}

/** A locus as a picture. */
export const locusPicture = (shown: LocusShown): Picture => ({
  ...pictureName("Locus"),
  legend: shown.traces.map(({ name, slot, tiltDeg }) => ({
    name: `${name}, long axis ${tiltText(tiltDeg)}`,
    colour: TRACE_COLOURS.light[slot],
  })),
  height: 660,
  paint: (pen, box, look) => paintLocus(pen, box, shown, look),
});
