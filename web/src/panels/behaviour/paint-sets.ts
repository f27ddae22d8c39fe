import type { Box, Pen } from "../../picture/pen";

import { tickLabels } from "../../ui/format";
import { CANVAS, fontFor } from "../../ui/palette";
import { linearTicks } from "../../ui/ticks";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { type Drawing, type Field, fieldOf, type Look } from "./drawing";
import { type Behaviour, type Sets, setsOf, setsWords } from "./sets";

const AIR = 1.12;
const LEAST_REACH = 3;
const CROSS = 7;
const SPARE: number[] = [5, 4];
/** Lines above and below a disc that its name may stand on. */
const LINES = [0, -1, 1, -2, 2];

/** A scale for both axes that holds every disc and the measured output. */
export function reachOf({ discs, measured }: Sets): { x: number; y: number; half: number } {
  const all = [...discs.map(({ x, y }) => ({ x, y, r: 1 })), { ...measured, r: 0.3 }];
  const ends = (of: (one: { x: number; y: number; r: number }) => [number, number]) => {
    const spans = all.map(of);
    return [Math.min(...spans.map(([low]) => low)), Math.max(...spans.map(([, high]) => high))];
  };
  const [left, right] = ends(({ x, r }) => [x - r, x + r]);
  const [low, high] = ends(({ y, r }) => [y - r, y + r]);
  const half = Math.max(LEAST_REACH, (AIR * Math.max(right - left, high - low)) / 2);
  return { x: (left + right) / 2, y: (low + high) / 2, half };
}

/** The behaviours as discs, filled where input and output belong to them, and a cross where the measured output lies. */
export function paintSets(pen: Pen, box: Box, look: Look, sets: Sets): void {
  const field = fieldOf(box, look);
  const reach = reachOf(sets);
  const scale = Math.min(field.right - field.left, field.bottom - field.top) / (2 * reach.half);
  const px = (x: number) => (field.left + field.right) / 2 + (x - reach.x) * scale;
  const py = (y: number) => (field.top + field.bottom) / 2 - (y - reach.y) * scale;
  paintGrid(pen, field, look, { px, py, scale });
  const ink = CANVAS[look.scheme];
  pen.save();
  pen.beginPath();
  pen.rect(field.left, field.top, field.right - field.left, field.bottom - field.top);
  pen.clip();
  sets.discs.forEach(({ x, y, holds }, i) => {
    const colour = traceColour(hypothesisStyle(i), look.scheme);
    pen.beginPath();
    pen.arc(px(x), py(y), scale, 0, 2 * Math.PI);
    pen.fillStyle = colour;
    pen.globalAlpha = holds ? 0.55 : 0.14;
    pen.fill();
    pen.globalAlpha = 1;
    pen.strokeStyle = colour;
    pen.lineWidth = holds ? 2.4 : 1.4;
    pen.setLineDash(holds || scale < 10 ? [] : SPARE);
    pen.stroke();
    pen.setLineDash([]);
  });
  paintNames(pen, look, field, sets, { px, py, scale });
  const { x, y } = sets.measured;
  for (const [colour, width] of [
    [ink.panel, 6],
    [ink.text, 2.4],
  ] as const) {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(px(x) - CROSS, py(y) - CROSS);
    pen.lineTo(px(x) + CROSS, py(y) + CROSS);
    pen.moveTo(px(x) - CROSS, py(y) + CROSS);
    pen.lineTo(px(x) + CROSS, py(y) - CROSS);
    pen.stroke();
  }
  pen.restore();
}

interface Scale {
  px(x: number): number;
  py(y: number): number;
  scale: number;
}

function paintGrid(pen: Pen, field: Field, look: Look, { px, py, scale }: Scale): void {
  const ink = CANVAS[look.scheme];
  const { left, top, right, bottom } = field;
  const xs = linearTicks((left - px(0)) / scale, (right - px(0)) / scale, (right - left) / 70);
  const ys = linearTicks((py(0) - bottom) / scale, (py(0) - top) / scale, (bottom - top) / 30);
  pen.font = fontFor(look.fontSize, 1);
  pen.strokeStyle = ink.grid;
  pen.fillStyle = ink.muted;
  pen.lineWidth = 1;
  pen.textAlign = "center";
  pen.textBaseline = "top";
  tickLabels(xs).forEach((label, i) => {
    line(pen, px(xs[i]), top, px(xs[i]), bottom);
    pen.fillText(label, px(xs[i]), bottom + 4);
  });
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  tickLabels(ys).forEach((label, i) => {
    line(pen, left, py(ys[i]), right, py(ys[i]));
    pen.fillText(label, left - 6, py(ys[i]));
  });
  if (look.isFramed) return;
  pen.textAlign = "right";
  pen.textBaseline = "top";
  pen.fillText(
    "output by the sine of the drive, in limits of the test",
    right,
    bottom + look.fontSize + 8,
    right - left,
  );
  pen.textAlign = "left";
  pen.textBaseline = "bottom";
  pen.fillText("output by its cosine; the cross is the one measured", left, top - 4, right - left);
}

/** The names beside their discs, right or left, on the first line that is free. */
function paintNames(pen: Pen, look: Look, field: Field, { discs }: Sets, { px, py, scale }: Scale): void {
  const height = look.fontSize + 3;
  const taken: { left: number; right: number; y: number }[] = [];
  pen.font = fontFor(look.fontSize, 1, 600);
  pen.textBaseline = "middle";
  pen.textAlign = "left";
  pen.fillStyle = CANVAS[look.scheme].text;
  for (const { name, x, y } of discs) {
    const width = pen.measureText(name).width;
    const right = px(x) + scale + 5;
    const left = px(x) - scale - 5 - width;
    const free = LINES.flatMap((line) =>
      [right, left].map((at) => ({ left: at, right: at + width, y: py(y) + line * height })),
    ).find(
      (one) =>
        one.left >= field.left &&
        one.right <= field.right &&
        !taken.some((other) => one.left < other.right && one.right > other.left && Math.abs(one.y - other.y) < height),
    );
    if (!free) continue;
    taken.push(free);
    pen.fillText(name, free.left, free.y);
  }
}

function line(pen: Pen, x1: number, y1: number, x2: number, y2: number): void {
  pen.beginPath();
  pen.moveTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
  pen.lineTo(Math.round(x2) + 0.5, Math.round(y2) + 0.5);
  pen.stroke();
}

/** The sets as a drawing. */
export function drawSets(behaviours: readonly Behaviour[], verdict: number): Drawing | undefined {
  const sets = setsOf(behaviours);
  return (
    sets && {
      words: setsWords(behaviours, verdict),
      across: "output by the sine of the drive, in limits of the test",
      up: "output by its cosine, in limits of the test",
      legend: [
        ...behaviours.map(({ words }, i) => ({
          name: words,
          colour: traceColour(hypothesisStyle(i), "light"),
          mark: "field" as const,
        })),
        { name: "cross: the output measured", colour: CANVAS.light.text, mark: "dot" },
      ],
      paint: (pen, box, look) => paintSets(pen, box, look, sets),
    }
  );
}
