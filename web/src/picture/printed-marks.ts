import type { PrintedMark } from "../api/types";
import { CANVAS, fontFor } from "../ui/palette";
import { type Place, placeOn } from "./axes";
import type { Field, Look, Pen } from "./pen";
import { fillHatched, paintRule, within } from "./traces";

/** How much of the colour of a trace is in the marks under it. */
const FAINT = 0.3;
const LINE = { width: 1.8, dashes: [10, 4, 2, 4] };

interface MarkedPlot {
  /** Ticks shown. */
  span: { start: number; end: number };
  /** The places of the values of a signal; undefined without an axis. */
  placeOf(signal: string): Place | undefined;
  colourOf(signal: string): string;
}

/**
 * The printed marks of a figure, under the traces: a hatched band, dashed lines at values, an upright line at a moment,
 * each with its number as printed.
 */
export function paintPrinted(
  pen: Pen,
  field: Field,
  marks: readonly PrintedMark[],
  plot: MarkedPlot,
  look: Look,
): void {
  const at = placeOn({ range: [plot.span.start, plot.span.end] }, field.left, field.right);
  const labels: Field[] = [];
  within(pen, field, () => {
    for (const mark of marks) {
      const y = plot.placeOf(mark.signal);
      const last = mark.until_tick ?? plot.span.end;
      if (!y || mark.from_tick > plot.span.end || last < plot.span.start) continue;
      const left = Math.max(at(mark.from_tick), field.left);
      const right = Math.min(at(last), field.right);
      const colour = plot.colourOf(mark.signal);
      const stroke = { ...LINE, colour };
      if (mark.low !== null && mark.high !== null) {
        const [top, bottom] = [Math.max(y(mark.high), field.top), Math.min(y(mark.low), field.bottom)];
        if (bottom <= top) continue;
        pen.save();
        pen.globalAlpha = FAINT;
        fillHatched(pen, left, top, right - left, bottom - top, colour);
        pen.restore();
        for (const edge of [mark.low, mark.high])
          paintRule(pen, [left, y(edge)], [right, y(edge)], { ...stroke, width: 1 });
        say(mark, left, right, bottom - top > 2 * look.fontSize ? [top + look.fontSize] : besides(top, bottom), colour);
      } else if (mark.kind === "moment") {
        paintRule(pen, [left, field.top], [left, field.bottom], stroke);
        say(mark, left, field.right, [field.top + look.fontSize], colour);
      } else {
        mark.values.forEach((value, i) => {
          paintRule(pen, [left, y(value)], [right, y(value)], stroke);
          if (i === 0) say(mark, left, right, besides(y(value), y(value)), colour);
        });
      }
    }
  });

  /** Above what reaches from top to bottom, or below it. */
  function besides(top: number, bottom: number): number[] {
    return [top - look.fontSize * 0.85, bottom + look.fontSize * 0.85];
  }

  /** Where there is room for it beside the mark: that it is printed, and the number; or the number alone. */
  function say({ number }: PrintedMark, left: number, right: number, rows: number[], colour: string): void {
    const { fontSize, scheme } = look;
    pen.font = fontFor(fontSize, 1, 600);
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    for (const text of [`printed: ${number}`, number])
      for (const middle of rows) {
        const half = fontSize * 0.7;
        const room = {
          left: left + 3,
          right: left + pen.measureText(text).width + 9,
          top: middle - half,
          bottom: middle + half,
        };
        if (room.right > right || room.top < field.top || room.bottom > field.bottom) continue;
        if (labels.some((other) => overlap(other, room))) continue;
        labels.push(room);
        pen.fillStyle = `${CANVAS[scheme].panel}cc`;
        pen.fillRect(room.left, room.top, room.right - room.left, room.bottom - room.top);
        pen.fillStyle = colour;
        pen.fillText(text, left + 6, middle);
        return;
      }
  }
}

const overlap = (a: Field, b: Field) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/** An axis extends to a mark by at most so many times the range of the traces. */
const REACH = 1.5;

/** The range of the traces of a unit, extended to the visible marks near them. */
export function reachMarks(
  [low, high]: readonly [number, number],
  marks: readonly PrintedMark[],
  unit: string,
  span: { start: number; end: number },
): [number, number] {
  const room = REACH * Math.max(high - low, 1e-9);
  const ends = marks.flatMap((mark) =>
    mark.unit === unit && mark.from_tick < span.end && (mark.until_tick ?? span.end) > span.start
      ? [mark.low, mark.high, ...mark.values].filter((end) => end !== null)
      : [],
  );
  const near = ends.filter((end) => end > low - room && end < high + room);
  return [Math.min(low, ...near), Math.max(high, ...near)];
}
