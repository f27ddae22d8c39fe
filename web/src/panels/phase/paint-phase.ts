import type { UnstableRegion } from "../../api/types";
import { linearAxis, type Plot, paintAxes } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { paintDot, paintLine, paintRule, within } from "../../picture/traces";
import { CANVAS, TRACE_COLOURS } from "../../ui/palette";
import type { UnitScale } from "../../ui/unit-scale";
import type { Range } from "./phase-range";

interface PhaseAxis {
  range: Range;
  scale: UnitScale;
  name: string;
}

export interface PhaseShown {
  x: PhaseAxis;
  y: PhaseAxis;
  points: { x: Float32Array; y: Float32Array };
  /** The point under the pointer of another panel. */
  hovered: number | undefined;
  map: UnstableRegion | undefined;
  /** The parts of the map for these signals. */
  fits: { folds: boolean; boundary: boolean };
  /** In `TRACE_COLOURS`. */
  slot: number;
}

/** The trail fades in so many pieces. */
const PIECES = 24;
const shaded = (alarm: string) => `${alarm}2e`;

const axisOf = ({ range, scale, name }: PhaseAxis) =>
  linearAxis(range, scale.unit ? `${name}, ${scale.unit}` : name, scale);

/** A trajectory over the map of the unstable region. */
export function paintPhase(pen: Pen, box: Box, shown: PhaseShown, look: Look): void {
  const ink = CANVAS[look.scheme];
  const { x, y, points, hovered } = shown;
  const plot = paintAxes(pen, box, axisOf(x), axisOf(y), look, { isSquare: true, gutter: look.fontSize * 2.7 });
  within(pen, plot.field, () => {
    if (shown.map) paintMap(pen, plot, shown.map, shown.fits, ink.alarm);
    paintTrail(pen, plot, points, TRACE_COLOURS[look.scheme][shown.slot]);
    if (hovered === undefined) return;
    pen.strokeStyle = ink.accent;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(plot.x(points.x[hovered]), plot.y(points.y[hovered]), 6, 0, 2 * Math.PI);
    pen.stroke();
  });
}

function paintMap(pen: Pen, plot: Plot, map: UnstableRegion, fits: PhaseShown["fits"], alarm: string): void {
  const { left, right, top, bottom } = plot.field;
  const edge = fits.boundary ? map.boundary : undefined;
  pen.fillStyle = shaded(alarm);
  if (edge) {
    const there = edge.x_um.map((at, i) => [plot.x(at), plot.y(edge.speed_um_ms[i])] as const);
    const back = edge.x_um.map((at, i) => [plot.x(at), plot.y(-edge.speed_um_ms[i])] as const).reverse();
    pen.beginPath();
    pen.rect(left, top, right - left, bottom - top);
    loop(pen, [...there, ...back]);
    pen.fill("evenodd");
    pen.strokeStyle = alarm;
    pen.lineWidth = 1.5;
    pen.beginPath();
    loop(pen, [...there, ...back]);
    pen.stroke();
  }
  if (!fits.folds) return;
  for (const { x_um } of map.folds) {
    const at = plot.x(x_um);
    pen.fillStyle = shaded(alarm);
    if (!edge) pen.fillRect(x_um > 0 ? at : left, top, x_um > 0 ? right - at : at - left, bottom - top);
    paintRule(pen, [at, top], [at, bottom], { colour: alarm, width: 1, dashes: [6, 4] });
  }
}

function paintTrail(pen: Pen, plot: Plot, { x, y }: PhaseShown["points"], colour: string): void {
  const count = x.length;
  for (let piece = 0; piece < PIECES; piece += 1) {
    const from = Math.floor((piece * count) / PIECES);
    const to = Math.min(count, Math.floor(((piece + 1) * count) / PIECES) + 1);
    const alpha = 0.12 + (0.88 * (piece + 1)) / PIECES;
    paintLine(pen, plot, x.subarray(from, to), y.subarray(from, to), { colour, width: 1.8, alpha });
  }
  if (count > 0) paintDot(pen, plot.x(x[count - 1]), plot.y(y[count - 1]), 4.5, colour);
}

function loop(pen: Pen, points: readonly (readonly [number, number])[]): void {
  pen.moveTo(...points[0]);
  for (const point of points) pen.lineTo(...point);
  pen.closePath();
}

/** A phase plane as a picture. */
export function phasePicture(shown: PhaseShown): Picture {
  const trail = { name: "the latest darkest", colour: TRACE_COLOURS.light[shown.slot] };
  const unstable = { name: "unstable", colour: shaded(CANVAS.light.alarm), mark: "field" as const };
  return {
    ...pictureName("Phase plane"),
    legend: shown.map && shown.fits.folds ? [trail, unstable] : [trail],
    height: 500,
    paint: (pen, box, look) => paintPhase(pen, box, { ...shown, hovered: undefined }, look),
  };
}
