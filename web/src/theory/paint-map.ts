import type { InstabilityMap } from "../api/types";
import { linearAxis, type Plot, paintAxes } from "../picture/axes";
import type { Box, Look, Pen } from "../picture/pen";
import { fileStem, type Picture } from "../picture/picture";
import { paintRule } from "../picture/traces";
import { CANVAS } from "../ui/palette";

/** Growth, 1/time, that counts as none. */
export const STILL = 1e-7;

/** Orange against blue, which every eye tells apart. */
const UNSTABLE = { dark: [232, 112, 58], light: [200, 78, 0] };
const STABLE = { dark: [58, 124, 165], light: [86, 160, 210] };
const LIMIT = [6, 4];

/** Frequency to the right, gain upward: orange where something grows, the deeper the faster. */
export function paintMap(pen: Pen, box: Box, map: InstabilityMap, look: Look): Plot {
  const { frequency, gain, growth, critical_gain_constant: critical } = map;
  const highest = gain[gain.length - 1];
  const ends = [frequency[0], frequency[frequency.length - 1]] as const;
  const plot = paintAxes(
    pen,
    box,
    linearAxis(ends, "drive frequency ω, rad per unit of time"),
    linearAxis([0, highest], "adaptation gain"),
    look,
  );
  const { left, right, top, bottom } = plot.field;
  const cell = { wide: (right - left) / frequency.length, tall: (bottom - top) / gain.length };
  const rates = growth.flat();
  const fastest = Math.max(1e-9, ...rates);
  const slowest = Math.min(-1e-9, ...rates);
  growth.forEach((row, i) => {
    row.forEach((rate, j) => {
      const [r, g, b] = (rate > STILL ? UNSTABLE : STABLE)[look.scheme];
      const depth =
        rate > STILL ? 0.35 + 0.65 * Math.sqrt(rate / fastest) : 0.15 + 0.6 * Math.sqrt(Math.min(0, rate) / slowest);
      pen.fillStyle = `rgb(${r} ${g} ${b} / ${depth})`;
      const x = Math.round(left + i * cell.wide);
      const y = Math.round(bottom - (j + 1) * cell.tall);
      pen.fillRect(x, y, Math.round(left + (i + 1) * cell.wide) - x, Math.round(bottom - j * cell.tall) - y);
    });
  });
  if (critical !== null) {
    const limit = { colour: CANVAS[look.scheme].text, width: 1, dashes: LIMIT };
    paintRule(pen, [left, plot.y(critical)], [right, plot.y(critical)], limit);
  }
  return plot;
}

/** The point of the map under the pointer. */
export function cellAt({ frequency, gain, growth }: InstabilityMap, { field }: Plot, at: { x: number; y: number }) {
  const i = Math.floor(((at.x - field.left) / (field.right - field.left)) * frequency.length);
  const j = Math.floor(((field.bottom - at.y) / (field.bottom - field.top)) * gain.length);
  const rate = growth[i]?.[j];
  return rate === undefined ? undefined : { frequency: frequency[i], gain: gain[j], growth: rate };
}

/** An instability map as a picture. */
export function mapPicture(map: InstabilityMap, name: string): Picture {
  const limit = { name: "limit under a constant", colour: CANVAS.light.text, dashes: LIMIT };
  return {
    title: `Stability of one adapted gain under a sine: ${name}`,
    stem: fileStem(`instability-${name}`),
    legend: [
      { name: "grows, the deeper the faster", colour: `rgb(${UNSTABLE.light.join(" ")})`, mark: "field" },
      { name: "settles", colour: `rgb(${STABLE.light.join(" ")} / 0.6)`, mark: "field" },
      ...(map.critical_gain_constant === null ? [] : [limit]),
    ],
    height: 480,
    paint: (pen, box, look) => paintMap(pen, box, map, look),
  };
}
