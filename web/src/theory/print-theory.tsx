import type { InstabilityMap, PositiveReal } from "../api/types";
import { drawnSvg } from "../picture/drawn-svg";
import type { Picture } from "../picture/picture";
import { fileStem } from "../picture/picture-name";
import { CANVAS } from "../ui/palette";
import { GROWS, paintMap, SETTLES } from "./paint-map";
import { HEIGHT, Nyquist, OverFrequency } from "./real-part";

const INK = CANVAS.light;

/** The real part of a transfer function and its curve of Nyquist as a picture. */
export function printRealPart(found: PositiveReal, text: string): Picture {
  const title = `G(s) = ${text}`;
  return {
    title,
    stem: fileStem(`real-part-${text}`),
    legend: [
      { name: "G(jω)", colour: INK.accent },
      { name: "negative real part", colour: `${INK.alarm}14`, mark: "field" },
    ],
    height: HEIGHT,
    paint(pen, { width }) {
      const first = 0.58 * width;
      pen.add(drawnSvg(<OverFrequency found={found} width={first} />));
      pen.save();
      pen.translate(first, 0);
      pen.add(drawnSvg(<Nyquist found={found} width={width - first} />));
      pen.restore();
    },
  };
}

/** An instability map as a picture. */
export function printMap(map: InstabilityMap, name: string): Picture {
  const constant = { name: "limit under a constant", colour: INK.text, dashes: [6, 4] };
  return {
    title: `Stability of one adapted gain under a sine: ${name}`,
    stem: fileStem(`instability-${name}`),
    across: "drive frequency ω, rad per unit of time",
    up: "adaptation gain",
    legend: [
      { name: "grows, the deeper the faster", colour: GROWS, mark: "field" },
      { name: "settles", colour: SETTLES, mark: "field" },
      ...(map.critical_gain_constant === null ? [] : [constant]),
    ],
    height: 460,
    paint: (pen, { width, height }) => paintMap(pen, map, width, height, "light", true),
  };
}
