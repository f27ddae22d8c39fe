import type { Pen } from "../../picture/pen";
import { fontFor } from "../../ui/canvas-font";
import { formatShort, tickLabels } from "../../ui/format";
import { CANVAS, type Scheme } from "../../ui/palette";
import { linearTicks } from "../../ui/ticks";
import { UNITS, unitText } from "../../ui/unit-scale";
import type { Spectrum } from "./fourier";

export interface SpectrumPicture {
  width: number;
  height: number;
  spectrum: Spectrum;
  /** Highest frequency shown, kHz. */
  highest: number;
  /** Decades of amplitude: exponents of the lowest and the highest shown. */
  decades: [number, number];
  /** As the server writes it. */
  unit: string;
  colour: string;
  scheme: Scheme;
  fontSize: number;
  /** The titles of the axes stand outside. */
  isFramed?: boolean;
}

const LEFT = 58;
const RIGHT = 14;
const TOP = 8;
const BOTTOM = 36;

/** Decades say their unit where it takes a prefix: "1 µm, 100 nm"; else the title says it. */
const takesPrefix = (unit: string) => unit in UNITS;

export const amplitudeTitle = (unit: string) =>
  unitText(unit) === "" || takesPrefix(unit) ? "amplitude" : `amplitude, ${unitText(unit)}`;

/** Amplitude over frequency, logarithmic upwards; the largest of the bins that share a pixel is drawn. */
export function paintSpectrum(ctx: Pen, picture: SpectrumPicture): void {
  const { width, height, spectrum, highest, decades, scheme, fontSize } = picture;
  const ink = CANVAS[scheme];
  const right = width - RIGHT;
  const bottom = height - BOTTOM;
  const px = (kHz: number) => LEFT + (kHz / highest) * (right - LEFT);
  const py = (value: number) => {
    const share = (Math.log10(Math.max(value, 1e-30)) - decades[0]) / (decades[1] - decades[0]);
    return bottom - Math.min(1, Math.max(0, share)) * (bottom - TOP);
  };
  ctx.font = fontFor(fontSize, 1);
  ctx.strokeStyle = ink.grid;
  ctx.fillStyle = ink.muted;
  ctx.lineWidth = 1;
  ctx.textAlign = "center";
  ctx.textBaseline = "top";
  const across = linearTicks(0, highest, (right - LEFT) / 90);
  tickLabels(across).forEach((label, i) => {
    line(ctx, px(across[i]), TOP, px(across[i]), bottom);
    ctx.fillText(label, px(across[i]), bottom + 4);
  });
  ctx.textAlign = "right";
  if (!picture.isFramed) ctx.fillText("kHz", right, bottom + 4 + fontSize);
  ctx.textBaseline = "middle";
  for (let power = decades[0]; power <= decades[1]; power += 1) {
    const y = py(10 ** power);
    line(ctx, LEFT, y, right, y);
    ctx.fillText(formatShort(10 ** power, takesPrefix(picture.unit) ? picture.unit : ""), LEFT - 6, y);
  }
  if (!picture.isFramed) {
    ctx.textAlign = "left";
    ctx.textBaseline = "top";
    ctx.fillText(amplitudeTitle(picture.unit), LEFT + 6, TOP + 2);
  }

  ctx.strokeStyle = picture.colour;
  ctx.lineWidth = 1.6;
  ctx.beginPath();
  let column = -1;
  let peak = 0;
  for (let i = 1; i < spectrum.frequency.length && spectrum.frequency[i] <= highest; i += 1) {
    const here = Math.round(px(spectrum.frequency[i]));
    if (here !== column && column >= 0) ctx.lineTo(column, py(peak));
    peak = here === column ? Math.max(peak, spectrum.amplitude[i]) : spectrum.amplitude[i];
    column = here;
  }
  ctx.lineTo(column, py(peak));
  ctx.stroke();
}

function line(ctx: Pen, x1: number, y1: number, x2: number, y2: number): void {
  ctx.beginPath();
  ctx.moveTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
  ctx.lineTo(Math.round(x2) + 0.5, Math.round(y2) + 0.5);
  ctx.stroke();
}
