import { axisOf } from "../../picture/axis-of";
import type { Box, Pen } from "../../picture/pen";
import type { Picture } from "../../picture/picture";
import { pictureName } from "../../picture/picture-name";
import { fontFor } from "../../ui/canvas-font";
import { CANVAS } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { paintTime } from "./paint-bands";
import { paintRow, paintTruth, type RacePicture, rowLayout } from "./paint-race";

const FONT = 13;
/** Room for the names of the diagnosers, px. */
const NAMES = 150;
const TRUTH = 34;
const ROW = 104;
const GAP = 10;
const FEET = 24;
const PAPER = { scheme: "light", fontSize: FONT, hover: undefined, picked: undefined } as const;

interface Row {
  id: string;
  row: RacePicture;
}

/** A race as a picture: the truth, then a field for each diagnoser, on one axis of time. */
export function printRace(head: RacePicture | undefined, rows: Row[]): Picture | undefined {
  const first = head ?? rows[0]?.row;
  if (!first) return undefined;
  const fieldOf = ({ width, height }: Box) => ({ left: NAMES, right: width, top: 0, bottom: height - FEET });
  return {
    ...pictureName(`Race of ${rows.length} diagnosers`),
    up: "probabilities, stacked from 0 to 1",
    legend: first.names.map((name, i) => ({
      name,
      colour: traceColour(hypothesisStyle(i), "light"),
      mark: "field",
    })),
    height: (head ? TRUTH : 0) + rows.length * (ROW + GAP) + FEET,
    time: axisOf(first, fieldOf),
    paint(pen, box) {
      const width = box.width - NAMES;
      const layout = { ...rowLayout(width, ROW, FONT), axis: box.height - FEET };
      const x = (tick: number) => ((tick - first.span.start) / (first.span.end - first.span.start)) * width;
      pen.save();
      pen.translate(NAMES, 0);
      pen.textBaseline = "middle";
      paintTime(pen, { ...first, ...PAPER, layout }, x);
      pen.restore();
      let top = 0;
      if (head) {
        const band = { ...layout, truth: 4, band: FONT + 8 };
        paintPart(pen, "truth", top, width, TRUTH, () => paintTruth(pen, { ...head, ...PAPER, layout: band }));
        top += TRUTH;
      }
      for (const { id, row } of rows) {
        paintPart(pen, id.replaceAll("_", " "), top, width, ROW, () =>
          paintRow(pen, { ...row, ...PAPER, layout: rowLayout(width, ROW, FONT) }),
        );
        top += ROW + GAP;
      }
    },
  };
}

function paintPart(pen: Pen, name: string, top: number, width: number, height: number, paint: () => void): void {
  pen.font = fontFor(FONT, 1, 600);
  pen.fillStyle = CANVAS.light.text;
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  pen.fillText(name, NAMES - 12, top + height / 2, NAMES - 24);
  pen.save();
  pen.translate(NAMES, top);
  pen.beginPath();
  pen.rect(0, 0, width, height);
  pen.clip();
  paint();
  pen.restore();
}
