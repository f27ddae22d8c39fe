import type { UnstableRegion } from "../../api/types";
import type { Pen } from "../../picture/pen";
import { fontFor } from "../../ui/canvas-font";
import { labelsOn } from "../../ui/format";
import { CANVAS, type Scheme } from "../../ui/palette";
import { linearTicks } from "../../ui/ticks";
import type { UnitScale } from "../../ui/unit-scale";
import type { Range } from "./phase-range";

export interface PhaseAxis {
  range: Range;
  scale: UnitScale;
  name: string;
}

export interface PhasePicture {
  width: number;
  height: number;
  x: PhaseAxis;
  y: PhaseAxis;
  points: { x: Float32Array; y: Float32Array };
  /** The point under the pointer of another panel. */
  hovered: number | undefined;
  map: UnstableRegion | undefined;
  /** Which parts of the map lie beneath these signals. */
  fits: { folds: boolean; boundary: boolean };
  colour: string;
  scheme: Scheme;
  fontSize: number;
  /** The titles of the axes stand outside. */
  isFramed?: boolean;
}

const LEFT = 58;
const BOTTOM = 38;
const TOP = 8;
const RIGHT = 12;
/** The trail fades in so many pieces. */
const PIECES = 24;

export const phaseTitle = ({ name, scale }: PhaseAxis) => (scale.unit ? `${name}, ${scale.unit}` : name);

/** The square field of a plane in a picture: as large as it can be, in the middle; above it stands a title, or none. */
export function squareField(width: number, height: number, title: number): Field {
  const above = TOP + title;
  const side = Math.max(0, Math.floor(Math.min(width - LEFT - RIGHT, height - above - BOTTOM)));
  const left = Math.round(LEFT + (width - LEFT - RIGHT - side) / 2);
  const top = Math.round(above + (height - above - BOTTOM - side) / 2);
  return { left, top, right: left + side, bottom: top + side };
}

interface Field {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** A trajectory over the map of the unstable region. */
export function paintPhase(ctx: Pen, picture: PhasePicture): void {
  const { width, height, scheme, fontSize } = picture;
  const ink = CANVAS[scheme];
  const field = squareField(width, height, picture.isFramed ? 0 : fontSize);
  const { left, top, right, bottom } = field;
  const px = (value: number) => left + ((value - picture.x.range[0]) / span(picture.x.range)) * (right - left);
  const py = (value: number) => bottom - ((value - picture.y.range[0]) / span(picture.y.range)) * (bottom - top);

  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, right - left, bottom - top);
  ctx.clip();
  if (picture.map) paintMap(ctx, picture, px, py, field, ink.alarm);
  ctx.restore();

  ctx.font = fontFor(fontSize, 1);
  ctx.strokeStyle = ink.grid;
  ctx.fillStyle = ink.muted;
  ctx.lineWidth = 1;
  ctx.textAlign = "center";
  ctx.textBaseline = "top";
  const across = scaled(picture.x, (right - left) / 60);
  labelsOn(picture.x.scale, across).forEach((label, i) => {
    line(ctx, px(across[i]), top, px(across[i]), bottom);
    ctx.fillText(label, px(across[i]), bottom + 4);
  });
  ctx.textAlign = "right";
  ctx.textBaseline = "middle";
  const up = scaled(picture.y, (bottom - top) / 30);
  labelsOn(picture.y.scale, up).forEach((label, i) => {
    line(ctx, left, py(up[i]), right, py(up[i]));
    ctx.fillText(label, left - 6, py(up[i]));
  });
  if (!picture.isFramed) {
    ctx.textBaseline = "bottom";
    ctx.fillText(phaseTitle(picture.x), right, bottom + BOTTOM - 2);
    ctx.textAlign = "left";
    ctx.fillText(phaseTitle(picture.y), left - LEFT + 12, top - 4);
  }

  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, right - left, bottom - top);
  ctx.clip();
  paintTrail(ctx, picture, px, py);
  if (picture.hovered !== undefined) {
    ctx.strokeStyle = ink.accent;
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.arc(px(picture.points.x[picture.hovered]), py(picture.points.y[picture.hovered]), 6, 0, 2 * Math.PI);
    ctx.stroke();
  }
  ctx.restore();
}

type Place = (value: number) => number;

function paintMap(
  ctx: Pen,
  { map, fits, x, fontSize }: PhasePicture,
  px: Place,
  py: Place,
  { left, top, right, bottom }: Field,
  alarm: string,
): void {
  const edge = fits.boundary ? map?.boundary : undefined;
  ctx.fillStyle = `${alarm}2e`;
  if (edge) {
    const inside = [
      ...edge.x_um.map((at, i) => [px(at), py(edge.speed_um_ms[i])] as const),
      ...edge.x_um.map((at, i) => [px(at), py(-edge.speed_um_ms[i])] as const).reverse(),
    ];
    ctx.beginPath();
    ctx.rect(left, top, right - left, bottom - top);
    loop(ctx, inside);
    ctx.fill("evenodd");
    ctx.strokeStyle = alarm;
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    loop(ctx, inside);
    ctx.stroke();
  }
  if (!fits.folds || !map) return;
  ctx.strokeStyle = alarm;
  ctx.setLineDash([6, 4]);
  ctx.font = fontFor(fontSize, 1);
  for (const fold of map.folds) {
    const at = px(fold.x_um);
    if (!edge) {
      if (fold.x_um > 0) ctx.fillRect(at, top, px(x.range[1]) - at, bottom - top);
      else ctx.fillRect(left, top, at - left, bottom - top);
    }
    line(ctx, at, top, at, bottom);
  }
  ctx.setLineDash([]);
}

function paintTrail(ctx: Pen, { points, colour }: PhasePicture, px: Place, py: Place): void {
  const count = points.x.length;
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.8;
  ctx.lineJoin = "round";
  for (let piece = 0; piece < PIECES; piece += 1) {
    const from = Math.floor((piece * count) / PIECES);
    const to = Math.min(count - 1, Math.floor(((piece + 1) * count) / PIECES));
    ctx.globalAlpha = 0.12 + (0.88 * (piece + 1)) / PIECES;
    ctx.beginPath();
    let drawing = false;
    for (let i = from; i <= to; i += 1) {
      const there = Number.isFinite(points.x[i]) && Number.isFinite(points.y[i]);
      if (there && drawing) ctx.lineTo(px(points.x[i]), py(points.y[i]));
      if (there && !drawing) ctx.moveTo(px(points.x[i]), py(points.y[i]));
      drawing = there;
    }
    ctx.stroke();
  }
  ctx.globalAlpha = 1;
  if (count === 0 || !Number.isFinite(points.x[count - 1])) return;
  ctx.fillStyle = colour;
  ctx.beginPath();
  ctx.arc(px(points.x[count - 1]), py(points.y[count - 1]), 4.5, 0, 2 * Math.PI);
  ctx.fill();
}

/** Ticks that are round in the unit shown. */
function scaled({ range, scale }: PhaseAxis, count: number): number[] {
  return linearTicks(range[0] * scale.factor, range[1] * scale.factor, Math.max(2, count)).map((t) => t / scale.factor);
}

const span = ([low, high]: Range) => high - low;

function loop(ctx: Pen, points: readonly (readonly [number, number])[]): void {
  ctx.moveTo(...points[0]);
  for (const point of points) ctx.lineTo(...point);
  ctx.closePath();
}

function line(ctx: Pen, x1: number, y1: number, x2: number, y2: number): void {
  ctx.beginPath();
  ctx.moveTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
  ctx.lineTo(Math.round(x2) + 0.5, Math.round(y2) + 0.5);
  ctx.stroke();
}
