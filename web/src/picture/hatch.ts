import type { Pen } from "./pen";

const STEP = 8;

/** Fill a field with the diagonal hatch of a colour: a guess, as against the solid of what is known. */
export function fillHatched(pen: Pen, left: number, top: number, width: number, height: number, colour: string): void {
  pen.fillStyle = `${colour}40`;
  pen.fillRect(left, top, width, height);
  pen.strokeStyle = colour;
  pen.lineWidth = 2.4;
  pen.beginPath();
  const right = left + width;
  const bottom = top + height;
  // lines of one x + y each, so that the hatches of neighbours meet
  for (let sum = Math.ceil((left + top) / STEP) * STEP; sum < right + bottom; sum += STEP) {
    const from = Math.max(left, sum - bottom);
    const to = Math.min(right, sum - top);
    pen.moveTo(from, sum - from);
    pen.lineTo(to, sum - to);
  }
  pen.stroke();
}
