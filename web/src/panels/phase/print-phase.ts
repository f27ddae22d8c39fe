import type { Picture } from "../../picture/picture";
import { pictureName } from "../../picture/picture-name";
import { CANVAS, onWhite } from "../../ui/palette";
import { type PhasePicture, paintPhase, phaseTitle } from "./paint-phase";

const ALARM = CANVAS.light.alarm;

/** A phase plane as a picture. */
export function printPhase(shown: PhasePicture): Picture {
  const { x, y, map, fits } = shown;
  const colour = onWhite(shown.colour);
  const trail = { name: "the latest darkest", colour };
  const ofPaper = { ...shown, colour, scheme: "light", fontSize: 13, hovered: undefined, isFramed: true } as const;
  return {
    ...pictureName("Phase plane"),
    across: phaseTitle(x),
    up: phaseTitle(y),
    legend: map && fits.folds ? [trail, { name: "unstable", colour: `${ALARM}2e`, mark: "field" }] : [trail],
    height: 480,
    paint: (pen, box) => paintPhase(pen, { ...ofPaper, ...box }),
  };
}
