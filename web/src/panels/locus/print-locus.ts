import type { Picture } from "../../picture/picture";
import { pictureName } from "../../picture/picture-name";
import { onWhite } from "../../ui/palette";
import { type LocusPicture, paintLocus, tiltText } from "./paint-locus";

/** A locus as a picture. */
export function printLocus(shown: LocusPicture): Picture {
  const traces = shown.traces.map((trace) => ({ ...trace, colour: onWhite(trace.colour) }));
  const ofPaper = { ...shown, traces, scheme: "light", fontSize: 13, isFramed: true } as const;
  return {
    ...pictureName("Locus"),
    across: `x, ${shown.scales.x.unit}`,
    up: `y, ${shown.scales.y.unit}`,
    legend: traces.map(({ name, colour, tiltDeg }) => ({ name: `${name}, long axis ${tiltText(tiltDeg)}`, colour })),
    height: 640,
    paint: (pen, box) => paintLocus(pen, { ...ofPaper, ...box }),
  };
}
