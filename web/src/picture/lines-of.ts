import type { Pen } from "./pen";

/** A text in lines that fit a width, px; a word that is wider has a line of its own. */
export function linesOf(pen: Pick<Pen, "measureText">, text: string, width: number): string[] {
  const lines: string[] = [];
  for (const word of text.split(" ")) {
    const last = lines.pop();
    const longer = last === undefined ? word : `${last} ${word}`;
    if (last === undefined || pen.measureText(longer).width <= width) lines.push(longer);
    else lines.push(last, word);
  }
  return lines;
}
