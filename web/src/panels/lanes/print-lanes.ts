import { axisOf } from "../../picture/axis-of";
import type { Box } from "../../picture/pen";
import type { Picture } from "../../picture/picture";
import { pictureName } from "../../picture/picture-name";
import { lanesLayout } from "./lanes-layout";
import { type LanesPicture, paintLanes } from "./paint-lanes";

const FONT = 13;
const LANE = 46;
const BANDS = 100;

/** The lanes of a diagnoser as a picture. */
export function printLanes(shown: LanesPicture, id: string): Picture {
  const lanes = shown.names.length;
  const left = (shown.layout.left * FONT) / shown.fontSize;
  const layout = ({ width, height }: Box) => lanesLayout(width, height, lanes, FONT, left);
  const ofPaper = { ...shown, scheme: "light", fontSize: FONT, hover: undefined, picked: undefined } as const;
  return {
    ...pictureName(`Diagnosis by ${id.replaceAll("_", " ")}`),
    up: "probability of each hypothesis, 0 to 1",
    height: LANE * lanes + BANDS,
    time: axisOf(shown, (box) => ({
      left: layout(box).left,
      right: layout(box).right,
      top: 0,
      bottom: layout(box).axis,
    })),
    paint: (pen, box) => paintLanes(pen, { ...ofPaper, layout: layout(box) }),
  };
}
