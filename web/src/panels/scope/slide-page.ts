import { paintLegend } from "../../picture/legend";
import { linesOf } from "../../picture/lines-of";
import type { Field, Pen } from "../../picture/pen";
import { paintRule } from "../../picture/traces";
import { CANVAS, fontFor } from "../../ui/palette";
import { type ScopeShown, scopePicture } from "./paint-scope";

/** A slide on light paper, 16:9, its letters to be read from the last row. */
export const WIDTH = 1280;
export const HEIGHT = 720;
export const EDGE = 40;
export const INK = CANVAS.light;
const LETTERS = 20;

/** The traces of a scope with their legend, by the painter of scopes. */
export function paintTraces(pen: Pen, shown: ScopeShown, { left, top, right, bottom }: Field): void {
  const look = { scheme: "light" as const, fontSize: LETTERS };
  const picture = scopePicture(shown, "", "");
  pen.save();
  pen.translate(left, top);
  const below = paintLegend(pen, picture.legend ?? [], 0, 10, right - left, LETTERS - 2) + 12;
  pen.translate(0, below);
  const box = { width: right - left, height: bottom - top - below - 6 };
  picture.paint(pen, box, look);
  pen.restore();
}

export function write(
  pen: Pen,
  text: string,
  x: number,
  y: number,
  size: number,
  weight: number,
  room: number,
  colour: string = INK.text,
): void {
  pen.font = fontFor(size, 1, weight);
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  pen.fillStyle = colour;
  pen.fillText(text, x, y, room);
}

/** A text in lines that have room. */
export function wrapped(pen: Pen, text: string, size: number, room: number): string[] {
  pen.font = fontFor(size, 1, 650);
  return linesOf(pen, text, room);
}

/** Where the slide comes from, under a rule. */
export function paintFoot(pen: Pen, words: string): void {
  paintRule(pen, [EDGE, HEIGHT - 40], [WIDTH - EDGE, HEIGHT - 40], { colour: INK.grid, width: 1 });
  write(pen, words, EDGE, HEIGHT - 20, 15, 450, WIDTH - 2 * EDGE, INK.muted);
}
