import type { Pen } from "../../picture/pen";
import { fontFor } from "../../ui/canvas-font";
import { formatIn, labelsOn } from "../../ui/format";
import { CANVAS, type Scheme } from "../../ui/palette";
import { linearTicks } from "../../ui/ticks";
import type { UnitScale } from "../../ui/unit-scale";
import type { Range } from "../phase/phase-range";
import type { LocusAxes, Points } from "./locus-axes";

export interface LocusTrace {
  name: string;
  colour: string;
  points: Points;
  /** Of its long axis; undefined while nothing moves. */
  tiltDeg: number | undefined;
}

export interface LocusPicture {
  width: number;
  height: number;
  axes: LocusAxes;
  scales: { x: UnitScale; y: UnitScale };
  traces: readonly LocusTrace[];
  scheme: Scheme;
  fontSize: number;
  /** The titles of the axes stand outside. */
  isFramed?: boolean;
}

const LEFT = 58;
const RIGHT = 12;
const TOP = 8;
const BOTTOM = 24;
const DASH = [7, 4];

/** The tilt in words. */
export const tiltText = (degrees: number | undefined) =>
  degrees === undefined ? "at rest" : formatIn(degrees, "°", Math.abs(degrees) < 10 ? 3 : 2);

/** The square of a locus within its place. */
function square({ width, height, fontSize, isFramed }: LocusPicture) {
  const title = isFramed ? 0 : fontSize + 4;
  const top = TOP + title;
  const side = Math.min(width - LEFT - RIGHT, height - top - BOTTOM - title);
  const left = LEFT + (width - LEFT - RIGHT - side) / 2;
  return { left, top, right: left + side, bottom: top + side };
}

/** The path of the mass in its plane, and the line along which it swings. */
export function paintLocus(ctx: Pen, picture: LocusPicture): void {
  const { axes, scheme, fontSize, scales } = picture;
  const ink = CANVAS[scheme];
  const { left, top, right, bottom } = square(picture);
  const px = (value: number) => left + ((value - axes.x[0]) / span(axes.x)) * (right - left);
  const py = (value: number) => bottom - ((value - axes.y[0]) / span(axes.y)) * (bottom - top);
  ctx.font = fontFor(fontSize, 1);
  ctx.strokeStyle = ink.grid;
  ctx.fillStyle = ink.muted;
  ctx.lineWidth = 1;
  ctx.textAlign = "center";
  ctx.textBaseline = "top";
  const across = ticks(axes.x, scales.x.factor, (right - left) / 50);
  labelsOn(scales.x, across).forEach((label, i) => {
    line(ctx, px(across[i]), top, px(across[i]), bottom);
    ctx.fillText(label, px(across[i]), bottom + 4);
  });
  ctx.textAlign = "right";
  ctx.textBaseline = "middle";
  const up = ticks(axes.y, scales.y.factor, (bottom - top) / 36);
  labelsOn(scales.y, up).forEach((label, i) => {
    line(ctx, left, py(up[i]), right, py(up[i]));
    ctx.fillText(label, left - 6, py(up[i]));
  });
  if (!picture.isFramed) {
    ctx.textBaseline = "top";
    ctx.fillText(`x, ${scales.x.unit}`, right, bottom + fontSize + 8);
    ctx.textAlign = "left";
    ctx.textBaseline = "bottom";
    ctx.fillText(`y, ${scales.y.unit}`, left, top - 4);
  }
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, right - left, bottom - top);
  ctx.clip();
  for (const trace of picture.traces) {
    paintAxis(ctx, trace, axes, px, py);
    paintPath(ctx, trace, px, py);
  }
  ctx.restore();
}

type Place = (value: number) => number;

/** The long axis, from edge to edge. */
function paintAxis(ctx: Pen, { tiltDeg, colour }: LocusTrace, axes: LocusAxes, px: Place, py: Place): void {
  if (tiltDeg === undefined) return;
  const reach = 2 * Math.max(axes.x[1], axes.y[1]);
  const turn = (tiltDeg * Math.PI) / 180;
  const [dx, dy] = [reach * Math.cos(turn), reach * Math.sin(turn)];
  ctx.strokeStyle = colour;
  ctx.globalAlpha = 0.7;
  ctx.lineWidth = 1;
  ctx.setLineDash(DASH);
  ctx.beginPath();
  ctx.moveTo(px(-dx), py(-dy));
  ctx.lineTo(px(dx), py(dy));
  ctx.stroke();
  ctx.setLineDash([]);
  ctx.globalAlpha = 1;
}

function paintPath(ctx: Pen, { points, colour }: LocusTrace, px: Place, py: Place): void {
  ctx.strokeStyle = ctx.fillStyle = colour;
  ctx.lineWidth = 1.8;
  ctx.lineJoin = "round";
  ctx.beginPath();
  let last = -1;
  for (let i = 0; i < points.x.length; i += 1) {
    if (!Number.isFinite(points.x[i] + points.y[i])) continue;
    if (last === i - 1 && i > 0) ctx.lineTo(px(points.x[i]), py(points.y[i]));
    else ctx.moveTo(px(points.x[i]), py(points.y[i]));
    last = i;
  }
  ctx.stroke();
  if (last < 0) return;
  ctx.beginPath();
  ctx.arc(px(points.x[last]), py(points.y[last]), 4.5, 0, 2 * Math.PI);
  ctx.fill();
}

/** Ticks that are round in the unit shown. */
const ticks = ([low, high]: Range, factor: number, count: number): number[] =>
  linearTicks(low * factor, high * factor, Math.max(2, count)).map((t) => t / factor);

const span = ([low, high]: Range) => high - low;

function line(ctx: Pen, x1: number, y1: number, x2: number, y2: number): void {
  ctx.beginPath();
  ctx.moveTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
  ctx.lineTo(Math.round(x2) + 0.5, Math.round(y2) + 0.5);
  ctx.stroke();
}
