import { formatShort } from "../ui/format";
import { DASHES, type Scheme, TRACE_COLOURS } from "../ui/palette";
import { linearAxis, type Plot, paintAxes, type Range } from "./axes";
import type { LegendEntry } from "./legend";
import type { Box, Look, Pen } from "./pen";
import { paintBand, paintLine, paintPoints, within } from "./traces";

export interface ChartLine {
  name: string;
  x: readonly number[];
  y: readonly number[];
  /** Half the width of the band at each point. */
  spread?: readonly number[];
  isStepped?: boolean;
  /** Points alone. */
  isDotted?: boolean;
}

export interface LinesShown {
  xLabel: string;
  yLabel: string;
  lines: readonly ChartLine[];
  xRange?: Range;
  yRange?: Range;
}

const colourOf = (i: number, scheme: Scheme) => TRACE_COLOURS[scheme][1 + (i % (TRACE_COLOURS[scheme].length - 1))];
const dashesOf = (i: number) => DASHES[i % DASHES.length];

/** Names of lines, where there are several to tell apart. */
export const lineEntries = (lines: readonly ChartLine[], scheme: Scheme): LegendEntry[] =>
  lines.length > 1 ? lines.map(({ name }, i) => ({ name, colour: colourOf(i, scheme), dashes: dashesOf(i) })) : [];

/** Lines in their bands over two titled axes. */
export function paintLines(pen: Pen, box: Box, shown: LinesShown, look: Look): Plot {
  const { xLabel, yLabel, lines, xRange, yRange } = shown;
  const across = xRange ?? spanOf(lines.flatMap((line) => line.x));
  const up = yRange ?? spanOf(lines.flatMap((line) => line.y));
  const plot = paintAxes(pen, box, linearAxis(across, xLabel), linearAxis(up, yLabel), look);
  const { left, right, top, bottom } = plot.field;
  // a line along an edge of the field keeps its width
  within(pen, { left: left - 3, right: right + 3, top: top - 3, bottom: bottom + 3 }, () =>
    lines.forEach(({ x, y, spread, isStepped, isDotted }, i) => {
      const colour = colourOf(i, look.scheme);
      if (isDotted || x.length === 1) paintPoints(pen, plot, x, y, colour, spread);
      else {
        if (spread) paintBand(pen, plot, x, ...bandOf(y, spread), `${colour}38`);
        paintLine(pen, plot, x, y, { colour, dashes: dashesOf(i) }, isStepped);
      }
    }),
  );
  return plot;
}

/** The lower and the upper edge of a band. */
const bandOf = (y: readonly number[], spread: readonly number[]): [number[], number[]] => [
  y.map((value, i) => value - spread[i]),
  y.map((value, i) => value + spread[i]),
];

/** A range with some air around the values. */
function spanOf(values: readonly number[]): Range {
  const finite = values.filter(Number.isFinite);
  if (finite.length === 0) return [0, 1];
  const low = finite.reduce((a, b) => Math.min(a, b));
  const high = finite.reduce((a, b) => Math.max(a, b));
  if (high - low <= 1e-9 * Math.max(Math.abs(low), Math.abs(high))) {
    const air = 0.5 * Math.abs(high) || 0.5;
    return [low - air, high + air];
  }
  return [low - 0.04 * (high - low), high + 0.04 * (high - low)];
}

const REACH_PX = 40;

/** The words of the point nearest to a place, px. */
export function nearestPoint(
  lines: readonly ChartLine[],
  plot: Plot,
  at: { x: number; y: number },
  say = (line: number, point: number) =>
    `${formatShort(lines[line].x[point], "")}, ${formatShort(lines[line].y[point], "")}`,
): string | undefined {
  let best = REACH_PX;
  let found: [number, number] | undefined;
  lines.forEach((line, number) => {
    line.x.forEach((x, i) => {
      const far = Math.hypot(plot.x(x) - at.x, plot.y(line.y[i]) - at.y);
      if (!(far < best)) return;
      best = far;
      found = [number, i];
    });
  });
  if (!found) return undefined;
  const { name } = lines[found[0]];
  return (name ? `${name}: ` : "") + say(...found);
}
