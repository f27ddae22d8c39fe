import { CANVAS, fontFor } from "../ui/palette";
import type { Pen } from "./pen";
import { paintCross } from "./traces";

export interface LegendEntry {
  name: string;
  colour: string;
  /** Of a line; px. */
  dashes?: readonly number[];
  /** The mark before the name, if it is not a line. */
  mark?: "dot" | "cross" | "field";
}

const SIZE = 13;
const MARK = 28;
const BETWEEN = 22;

/** Names after their colours, in as many lines as they need; where the legend ends. */
export function paintLegend(
  pen: Pen,
  entries: readonly LegendEntry[],
  left: number,
  top: number,
  width: number,
  size = SIZE,
): number {
  const line = size + 7;
  if (entries.length === 0) return top - 6;
  pen.font = fontFor(size, 1, 400);
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  let x = left;
  let y = top;
  for (const { name, colour, dashes = [], mark } of entries) {
    const wide = MARK + 6 + pen.measureText(name).width;
    if (x > left && x + wide > left + width) {
      x = left;
      y += line;
    }
    pen.fillStyle = pen.strokeStyle = colour;
    pen.beginPath();
    if (mark === "field") pen.fillRect(x, y - 6, MARK, 12);
    else if (mark === "cross") paintCross(pen, x + MARK / 2, y, { colour, width: 2.4 });
    else if (mark === "dot") {
      pen.arc(x + MARK / 2, y, 4.5, 0, 2 * Math.PI);
      pen.fill();
    } else {
      pen.lineWidth = 2.2;
      pen.setLineDash([...dashes]);
      pen.moveTo(x, y);
      pen.lineTo(x + MARK, y);
      pen.stroke();
      pen.setLineDash([]);
    }
    pen.fillStyle = CANVAS.light.text;
    pen.fillText(name, x + MARK + 6, y);
    x += wide + BETWEEN;
  }
  return y + line - 6;
}
