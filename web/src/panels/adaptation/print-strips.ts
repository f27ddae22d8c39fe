import { axisOf } from "../../picture/axis-of";
import type { LegendEntry } from "../../picture/legend";
import type { Picture } from "../../picture/picture";
import { pictureName } from "../../picture/picture-name";
import { TRACE_COLOURS } from "../../ui/palette";
import type { LanePainting } from "../lanes/lane-canvas";
import { type Strip, signalsOf } from "./adaptation-strips";
import { AXIS_PX, gutter, paintStrips, RIGHT_PX } from "./paint-strips";

const FONT = 13;
const EACH = 84;

export const IDEAL: LegendEntry = { name: "ideal", colour: TRACE_COLOURS.light[0], dashes: [5, 4] };

/** Strips as a picture; each has its title on the left and the ends of its axis, with the unit, on the right. */
export function printStrips(
  shown: LanePainting,
  strips: readonly Strip[],
  what: string,
  legend: readonly LegendEntry[],
): Picture {
  const columnOf = new Map(strips.flatMap(signalsOf).map((name, i) => [name, i]));
  return {
    ...pictureName(what),
    legend,
    height: strips.length * EACH + AXIS_PX,
    time: axisOf(shown, ({ width, height }) => ({
      left: gutter(FONT),
      right: width - RIGHT_PX,
      top: 0,
      bottom: height - AXIS_PX,
    })),
    paint: (pen, box) =>
      paintStrips(pen, { ...shown, ...box, hover: undefined }, strips, columnOf, "light", FONT, EACH),
  };
}
