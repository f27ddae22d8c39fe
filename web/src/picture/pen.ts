import type { Scheme } from "../ui/palette";

/**
 * The part of a canvas that a painter may use: all of it can also be written as SVG.
 *
 * A painter that takes a `Pen` draws on the screen and into a file by the same lines.
 */
export interface Pen {
  fillStyle: string | CanvasGradient | CanvasPattern;
  strokeStyle: string | CanvasGradient | CanvasPattern;
  lineWidth: number;
  lineJoin: CanvasLineJoin;
  font: string;
  textAlign: CanvasTextAlign;
  textBaseline: CanvasTextBaseline;
  globalAlpha: number;
  save(): void;
  restore(): void;
  translate(x: number, y: number): void;
  rotate(angle: number): void;
  setLineDash(dashes: number[]): void;
  beginPath(): void;
  closePath(): void;
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
  rect(x: number, y: number, width: number, height: number): void;
  arc(x: number, y: number, radius: number, from: number, to: number): void;
  fill(rule?: CanvasFillRule): void;
  stroke(): void;
  clip(): void;
  fillRect(x: number, y: number, width: number, height: number): void;
  fillText(text: string, x: number, y: number, maxWidth?: number): void;
  measureText(text: string): { width: number };
}

/** The size of a painting, px. */
export interface Box {
  width: number;
  height: number;
}

/** A rectangle in a painting, px. */
export interface Field {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** The ground that is painted on, and the size of its letters, px. */
export interface Look {
  scheme: Scheme;
  fontSize: number;
}

/** The look of every picture that is kept. */
export const PAPER: Look = { scheme: "light", fontSize: 13 };
