import type { Box, Pen } from "../../picture/pen";

import { tickLabels } from "../../ui/format";
import { CANVAS, fontFor, TRACE_COLOURS } from "../../ui/palette";
import { decadeTicks, linearTicks } from "../../ui/ticks";
import { type Drawing, type Field, fieldOf, type Look } from "./drawing";
import { type Limits, type Path, REGIONS, regionsWords } from "./regions";

/** Losses shown; what is less or more lies at the edge. */
const LEAST = 0.005;
const MOST = 5;
/** Colours of the regions, from safe to danger: green, yellow, orange; the alarm is the page's. */
const SLOTS = [3, 6, 2];

/** The regions from safe to danger, and the way the device took through them. */
export function paintRegions(pen: Pen, box: Box, look: Look, path: Path, limits: Limits): void {
  const field = fieldOf(box, look);
  const { left, top, right, bottom } = field;
  const tall = Math.max(1.35 * limits.dangerUm, 1.08 * Math.max(...path.peakUm));
  const px = (loss: number) =>
    left + (Math.log(Math.min(Math.max(loss, LEAST), MOST) / LEAST) / Math.log(MOST / LEAST)) * (right - left);
  const py = (um: number) => bottom - (um / tall) * (bottom - top);
  const edges = [LEAST, limits.degraded, limits.unacceptable, limits.danger].map(px);
  const roof = py(limits.dangerUm);
  const ink = CANVAS[look.scheme];
  const tints = [...SLOTS.map((slot) => TRACE_COLOURS[look.scheme][slot]), ink.alarm];
  // danger lies all around what is safe
  pen.globalAlpha = 0.22;
  pen.fillStyle = tints[3];
  pen.fillRect(left, top, right - left, roof - top);
  pen.fillRect(edges[3], roof, right - edges[3], bottom - roof);
  for (let i = 0; i < 3; i += 1) {
    pen.fillStyle = tints[i];
    pen.fillRect(edges[i], roof, edges[i + 1] - edges[i], bottom - roof);
  }
  pen.globalAlpha = 1;
  paintAxes(pen, field, look, { px, py, tall });
  pen.font = fontFor(look.fontSize, 1, 600);
  pen.fillStyle = ink.text;
  pen.textBaseline = "top";
  pen.textAlign = "center";
  // in a narrow panel a name that would run into the one before stands a line lower
  const ends = [left, left];
  REGIONS.forEach((name, i) => {
    const middle = (edges[i] + (edges[i + 1] ?? right)) / 2;
    const half = pen.measureText(name).width / 2 + 3;
    const row = middle - half >= ends[0] ? 0 : 1;
    ends[row] = middle + half;
    pen.fillText(name, middle, roof + 6 + row * (look.fontSize + 4));
  });
  paintPath(pen, look, path, px, py);
}

interface Axes {
  px(loss: number): number;
  py(um: number): number;
  tall: number;
}

function paintAxes(pen: Pen, { left, right, top, bottom }: Field, look: Look, { px, py, tall }: Axes): void {
  const ink = CANVAS[look.scheme];
  pen.font = fontFor(look.fontSize, 1);
  pen.fillStyle = ink.muted;
  pen.textAlign = "center";
  pen.textBaseline = "top";
  const most = (right - left) / 52;
  const fine = decadeTicks(100 * LEAST, 100 * MOST);
  const across = fine.length <= most ? fine : fine.filter((tick) => Number.isInteger(Math.log10(tick)));
  across.forEach((tick) => {
    pen.fillText(tickLabels([tick])[0], px(tick / 100), bottom + 4);
  });
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  const up = linearTicks(0, tall, (bottom - top) / 44);
  tickLabels(up).forEach((label, i) => {
    pen.fillText(label, left - 6, py(up[i]));
  });
  if (look.isFramed) return;
  pen.textAlign = "right";
  pen.textBaseline = "top";
  pen.fillText("distance from the healthy motion, %", right, bottom + look.fontSize + 8, right - left);
  pen.textAlign = "left";
  pen.textBaseline = "bottom";
  pen.fillText("largest displacement, µm", left, top - 4);
}

/** The way in the last moments, thin, and a dot for now. */
function paintPath(pen: Pen, look: Look, { loss, peakUm }: Path, px: Axes["px"], py: Axes["py"]): void {
  const ink = CANVAS[look.scheme];
  pen.strokeStyle = ink.text;
  pen.lineWidth = 1.6;
  pen.lineJoin = "round";
  pen.beginPath();
  loss.forEach((value, i) => {
    if (i === 0) pen.moveTo(px(value), py(peakUm[i]));
    else pen.lineTo(px(value), py(peakUm[i]));
  });
  pen.stroke();
  const last = loss.length - 1;
  for (const [colour, radius] of [
    [ink.panel, 8],
    [ink.text, 5.5],
  ] as const) {
    pen.fillStyle = colour;
    pen.beginPath();
    pen.arc(px(loss[last]), py(peakUm[last]), radius, 0, 2 * Math.PI);
    pen.fill();
  }
}

/** The regions as a drawing. */
export function drawRegions(path: Path, region: number, limits: Limits): Drawing | undefined {
  const whole = path.loss.map((loss, i) => ({ loss, peakUm: path.peakUm[i] }));
  const known = whole.filter((one) => Number.isFinite(one.loss + one.peakUm));
  const kept = { loss: known.map((one) => one.loss), peakUm: known.map((one) => one.peakUm) };
  if (known.length === 0) return undefined;
  return {
    words: regionsWords(kept, region),
    across: "distance from the healthy motion, %",
    up: "largest displacement, µm",
    legend: [{ name: "where the device was, and is now", colour: CANVAS.light.text, mark: "dot" }],
    paint: (pen, box, look) => paintRegions(pen, box, look, kept, limits),
  };
}
