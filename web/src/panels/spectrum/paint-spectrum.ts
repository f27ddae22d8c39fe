import { linearAxis, logAxis, paintAxes } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { paintLine } from "../../picture/traces";
import { formatShort } from "../../ui/format";
import { TRACE_COLOURS } from "../../ui/palette";
import { UNITS, unitText } from "../../ui/unit-scale";
import type { Spectrum } from "./fourier";

export interface SpectrumShown {
  spectrum: Spectrum;
  /** Highest frequency shown, kHz. */
  highest: number;
  /** Decades of amplitude: exponents of the lowest and the highest shown. */
  decades: [number, number];
  /** As the server writes it. */
  unit: string;
  /** In `TRACE_COLOURS`. */
  slot: number;
}

/** Decades say their unit where it takes a prefix: "1 µm, 100 nm"; else the title says it. */
const takesPrefix = (unit: string) => unit in UNITS;

const amplitudeTitle = (unit: string) =>
  unitText(unit) === "" || takesPrefix(unit) ? "amplitude" : `amplitude, ${unitText(unit)}`;

/** Amplitude over frequency, logarithmic upwards; the largest of the bins that share a pixel is drawn. */
export function paintSpectrum(pen: Pen, box: Box, shown: SpectrumShown, look: Look): void {
  const { spectrum, highest, decades, unit, slot } = shown;
  const [least, most] = decades.map((power) => 10 ** power);
  const write = (value: number) => formatShort(value, takesPrefix(unit) ? unit : "");
  const up = logAxis([least, most], amplitudeTitle(unit), write);
  const plot = paintAxes(pen, box, linearAxis([0, highest], "frequency, kHz"), up, look, {
    gutter: look.fontSize * 3.8, // the axis moves by decades: the field stays
  });
  const pixels: number[] = [];
  const peaks: number[] = [];
  for (let i = 1; i < spectrum.frequency.length && spectrum.frequency[i] <= highest; i += 1) {
    const here = Math.round(plot.x(spectrum.frequency[i]));
    const amplitude = Math.min(Math.max(spectrum.amplitude[i], least), most);
    if (here !== pixels.at(-1)) {
      pixels.push(here);
      peaks.push(amplitude);
    } else peaks[peaks.length - 1] = Math.max(amplitude, peaks[peaks.length - 1]);
  }
  const stroke = { colour: TRACE_COLOURS[look.scheme][slot], width: 1.6 };
  paintLine(pen, { x: (pixel) => pixel, y: plot.y }, pixels, peaks, stroke);
}

/** A spectrum as a picture. */
export const spectrumPicture = (shown: SpectrumShown, signal: string): Picture => ({
  ...pictureName(`Spectrum of ${signal}`),
  height: 420,
  paint: (pen, box, look) => paintSpectrum(pen, box, shown, look),
});
