import type { InstabilityMap } from "../api/types";
import type { Pen } from "../picture/pen";
import { fontFor } from "../ui/canvas-font";
import { tickLabels } from "../ui/format";
import { CANVAS, type Scheme } from "../ui/palette";
import { linearTicks } from "../ui/ticks";

/** Room for the axes, CSS pixels. */
export const FIELD = { left: 44, bottom: 34, right: 8, top: 8 };

/** Growth, 1/time, that counts as none. */
export const STILL = 1e-7;

/** Orange against blue, which every eye tells apart. */
const UNSTABLE = { dark: [232, 112, 58], light: [200, 78, 0] };
const STABLE = { dark: [58, 124, 165], light: [86, 160, 210] };

/** On white, as a legend has them. */
export const GROWS = `rgb(${UNSTABLE.light.join(" ")})`;
export const SETTLES = `rgb(${STABLE.light.join(" ")} / 0.6)`;

/** Frequency to the right, gain upward: orange where something grows, the deeper the faster; framed, the titles of the axes stand outside. */
export function paintMap(
  ctx: Pen,
  { frequency, gain, growth, critical_gain_constant: critical }: InstabilityMap,
  width: number,
  height: number,
  scheme: Scheme,
  isFramed = false,
): void {
  const { left, bottom, right, top } = FIELD;
  const wide = width - left - right;
  const tall = height - top - bottom;
  const fastest = Math.max(1e-9, ...growth.flat());
  const slowest = Math.min(-1e-9, ...growth.flat());
  const cellWidth = wide / frequency.length;
  const cellHeight = tall / gain.length;
  growth.forEach((row, i) => {
    row.forEach((rate, j) => {
      const [r, g, b] = rate > STILL ? UNSTABLE[scheme] : STABLE[scheme];
      const depth =
        rate > STILL ? 0.35 + 0.65 * Math.sqrt(rate / fastest) : 0.15 + 0.6 * Math.sqrt(Math.min(0, rate) / slowest);
      ctx.fillStyle = `rgb(${r} ${g} ${b} / ${depth})`;
      const x = Math.round(left + i * cellWidth);
      const y = Math.round(top + tall - (j + 1) * cellHeight);
      ctx.fillRect(x, y, Math.round(left + (i + 1) * cellWidth) - x, Math.round(top + tall - j * cellHeight) - y);
    });
  });
  const colours = CANVAS[scheme];
  const highest = gain[gain.length - 1];
  const first = frequency[0];
  const last = frequency[frequency.length - 1];
  ctx.font = fontFor(12, 1);
  ctx.fillStyle = colours.muted;
  ctx.textBaseline = "middle";
  ctx.textAlign = "right";
  const rows = linearTicks(0, highest, 5);
  tickLabels(rows).forEach((label, i) => {
    ctx.fillText(label, left - 6, top + tall - (rows[i] / highest) * tall);
  });
  ctx.textAlign = "center";
  const columns = linearTicks(first, last, Math.max(2, wide / 70));
  tickLabels(columns).forEach((label, i) => {
    ctx.fillText(label, left + ((columns[i] - first) / (last - first)) * wide, height - bottom + 12);
  });
  if (!isFramed) {
    ctx.textAlign = "right";
    ctx.fillText("drive frequency ω", left + wide, height - 6);
    ctx.save();
    ctx.translate(8, top + tall / 2);
    ctx.rotate(-Math.PI / 2);
    ctx.textAlign = "center";
    ctx.fillText("adaptation gain", 0, 0);
    ctx.restore();
  }
  if (critical === null) return;
  const y = top + tall - (critical / highest) * tall;
  ctx.strokeStyle = colours.text;
  ctx.setLineDash([6, 4]);
  ctx.beginPath();
  ctx.moveTo(left, y);
  ctx.lineTo(left + wide, y);
  ctx.stroke();
  ctx.setLineDash([]);
}

/** The point of the map under the pointer. */
export function cellAt(map: InstabilityMap, x: number, y: number, width: number, height: number) {
  const { left, bottom, right, top } = FIELD;
  const i = Math.floor(((x - left) / (width - left - right)) * map.frequency.length);
  const j = Math.floor((1 - (y - top) / (height - top - bottom)) * map.gain.length);
  const growth = map.growth[i]?.[j];
  return growth === undefined ? undefined : { frequency: map.frequency[i], gain: map.gain[j], growth };
}
