import type { Picture } from "../../picture/picture";
import { pictureName } from "../../picture/picture-name";
import { onWhite } from "../../ui/palette";
import { amplitudeTitle, paintSpectrum, type SpectrumPicture } from "./paint-spectrum";

/** A spectrum as a picture. */
export function printSpectrum(shown: SpectrumPicture, signal: string): Picture {
  const ofPaper = { ...shown, colour: onWhite(shown.colour), scheme: "light", fontSize: 13, isFramed: true } as const;
  return {
    ...pictureName(`Spectrum of ${signal}`),
    across: "frequency, kHz",
    up: amplitudeTitle(shown.unit),
    height: 400,
    paint: (pen, box) => paintSpectrum(pen, { ...ofPaper, ...box }),
  };
}
