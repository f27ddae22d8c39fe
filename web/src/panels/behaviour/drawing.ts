import type { LegendEntry } from "../../picture/legend";
import type { Box, Pen } from "../../picture/pen";
import type { Scheme } from "../../ui/palette";

/** How a drawing is to look. */
export interface Look {
  scheme: Scheme;
  fontSize: number;
  /** The titles of the axes stand outside. */
  isFramed?: boolean;
}

/** What a diagnoser says, as a picture and as a sentence. */
export interface Drawing {
  words: string;
  across: string;
  up: string;
  legend: readonly LegendEntry[];
  paint(pen: Pen, box: Box, look: Look): void;
}

/** A field of a drawing, px. */
export interface Field {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Where the axes stand: room for their numbers, and for their titles where nobody else writes them. */
export function fieldOf({ width, height }: Box, { fontSize, isFramed }: Look): Field {
  const title = isFramed ? 0 : fontSize + 6;
  return { left: 46, top: 8 + title, right: width - 12, bottom: height - 22 - title };
}
