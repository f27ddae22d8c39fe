import { hypothesisWords } from "../../bench/hypothesis-words";
import { paintColumns, timeAxis } from "../../picture/axes";
import { eventAxis } from "../../picture/event-marks";
import type { Box, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { within } from "../../picture/traces";
import { CANVAS, fontFor } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { paintRow, paintTruth, type RaceShown } from "./paint-race";

/** Room for the names of the diagnosers, px. */
const NAMES = 150;
const TRUTH = 34;
const ROW = 104;
const GAP = 10;
const FEET = 24;

/** A race as a picture: the truth, then a field for each diagnoser, on one axis of time. */
export function racePicture(head: RaceShown | undefined, rows: { id: string; row: RaceShown }[]): Picture | undefined {
  const first = head ?? rows[0]?.row;
  if (!first) return undefined;
  const fieldOf = ({ width, height }: Box) => ({ left: NAMES, right: width, top: 0, bottom: height - FEET });
  return {
    ...pictureName(`Race of ${rows.length} diagnosers`),
    up: "probabilities, stacked from 0 to 1",
    legend: first.names.map((name, i) => ({
      name: hypothesisWords(name),
      colour: traceColour(hypothesisStyle(i), "light"),
      mark: "field",
    })),
    height: (head ? TRUTH : 0) + rows.length * (ROW + GAP) + FEET,
    time: eventAxis(first, fieldOf),
    paint(pen, box, look) {
      paintColumns(pen, fieldOf(box), timeAxis(first.span, first.frame.dtMs), look);
      const width = box.width - NAMES;
      const band = { width, height: TRUTH };
      if (head) paintPart(pen, "truth", 0, band, look, () => paintTruth(pen, band, head, look, 4));
      rows.forEach(({ id, row }, i) => {
        const place = { width, height: ROW };
        const shown = { ...row, hover: undefined, picked: undefined };
        const top = (head ? TRUTH : 0) + i * (ROW + GAP);
        paintPart(pen, id.replaceAll("_", " "), top, place, look, () => paintRow(pen, place, shown, look));
      });
    },
  };
}

function paintPart(pen: Pen, name: string, top: number, { width, height }: Box, look: Look, paint: () => void): void {
  pen.font = fontFor(look.fontSize, 1, 600);
  pen.fillStyle = CANVAS[look.scheme].text;
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  pen.fillText(name, NAMES - 12, top + height / 2, NAMES - 24);
  pen.save();
  pen.translate(NAMES, top);
  within(pen, { left: 0, right: width, top: 0, bottom: height }, paint);
  pen.restore();
}
