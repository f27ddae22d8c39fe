import { linearAxis, logAxis, type Plot, paintAxes } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { paintDot, paintLine } from "../../picture/traces";
import { tickLabels } from "../../ui/format";
import { CANVAS, fontFor, TRACE_COLOURS } from "../../ui/palette";
import { decadeTicks, powerTicks } from "../../ui/ticks";
import type { Drawing } from "./behaviour-plot";
import { type Limits, type Path, REGIONS, regionsWords } from "./regions";

/** Least and largest loss shown, %; others are drawn at the edge. */
const LEAST = 0.5;
const MOST = 500;
/** Room for the number of a loss, px. */
const NUMBER = 52;
/** Colours of the regions, from safe to danger: green, yellow, orange; the alarm is the page's. */
const SLOTS = [3, 6, 2];

const percent = (loss: number) => Math.min(Math.max(100 * loss, LEAST), MOST);

/** The regions from safe to danger, and the way the device took through them. */
function paintRegions(pen: Pen, box: Box, look: Look, path: Path, limits: Limits): void {
  const tall = Math.max(1.35 * limits.dangerUm, 1.08 * Math.max(...path.peakUm));
  const fine = decadeTicks(LEAST, MOST);
  const ticks = fine.length <= box.width / NUMBER ? fine : powerTicks(LEAST, MOST);
  const across = logAxis([LEAST, MOST], "distance from the healthy motion, %", (tick) => tickLabels([tick])[0], ticks);
  const plot = paintAxes(pen, box, across, linearAxis([0, tall], "largest displacement, µm"), look);
  const { left, right, top, bottom } = plot.field;
  const edges = [left, ...[limits.degraded, limits.unacceptable, limits.danger].map((loss) => plot.x(percent(loss)))];
  const roof = plot.y(limits.dangerUm);
  const ink = CANVAS[look.scheme];
  const tints = [...SLOTS.map((slot) => TRACE_COLOURS[look.scheme][slot]), ink.alarm];
  // danger surrounds the safe regions
  pen.globalAlpha = 0.22;
  pen.fillStyle = tints[3];
  pen.fillRect(left, top, right - left, roof - top);
  pen.fillRect(edges[3], roof, right - edges[3], bottom - roof);
  for (let i = 0; i < 3; i += 1) {
    pen.fillStyle = tints[i];
    pen.fillRect(edges[i], roof, edges[i + 1] - edges[i], bottom - roof);
  }
  pen.globalAlpha = 1;
  pen.font = fontFor(look.fontSize, 1, 600);
  pen.fillStyle = ink.text;
  pen.textBaseline = "top";
  pen.textAlign = "center";
  // in a narrow panel a name that would run into the last one is written a line lower
  const ends = [left, left];
  REGIONS.forEach((name, i) => {
    const middle = (edges[i] + (edges[i + 1] ?? right)) / 2;
    const half = pen.measureText(name).width / 2 + 3;
    const row = middle - half >= ends[0] ? 0 : 1;
    ends[row] = middle + half;
    pen.fillText(name, middle, roof + 6 + row * (look.fontSize + 4));
  });
  paintPath(pen, look, path, plot);
}

/** The path of the last moments, thin, and a dot for now. */
function paintPath(pen: Pen, look: Look, { loss, peakUm }: Path, plot: Plot): void {
  const ink = CANVAS[look.scheme];
  const across = loss.map(percent);
  paintLine(pen, plot, across, peakUm, { colour: ink.text, width: 1.6 });
  const last = loss.length - 1;
  const [x, y] = [plot.x(across[last]), plot.y(peakUm[last])];
  paintDot(pen, x, y, 8, ink.panel);
  paintDot(pen, x, y, 5.5, ink.text);
}

/** The regions as a drawing. */
export function drawRegions(path: Path, region: number, limits: Limits): Drawing | undefined {
  const whole = path.loss.map((loss, i) => ({ loss, peakUm: path.peakUm[i] }));
  const known = whole.filter((one) => Number.isFinite(one.loss + one.peakUm));
  const kept = { loss: known.map((one) => one.loss), peakUm: known.map((one) => one.peakUm) };
  if (known.length === 0) return undefined;
  return {
    words: regionsWords(kept, region),
    legend: [{ name: "where the device was, and is now", colour: CANVAS.light.text, mark: "dot" }],
    paint: (pen, box, look) => paintRegions(pen, box, look, kept, limits),
  };
}
