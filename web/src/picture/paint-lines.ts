import { formatShort, formatSpread } from "../ui/format";
import { DASHES, type Scheme, TRACE_COLOURS } from "../ui/palette";
import { linearAxis, type Plot, paintAxes, type Range } from "./axes";
import type { LegendEntry } from "./legend";
import type { Box, Look, Pen } from "./pen";
import { paintLine, paintPoints, within } from "./traces";

export interface ChartLine {
  name: string;
  x: readonly number[];
  y: readonly number[];
  /** Half the length of the bar at each point. */
  spread?: readonly number[];
  isStepped?: boolean;
}

export interface LinesShown {
  xLabel: string;
  yLabel: string;
  lines: readonly ChartLine[];
  xRange?: Range;
  yRange?: Range;
  /** What the figure cannot pass, such as 0 for a count: bars end there. */
  yLimits?: Range;
}

/** Bars show how far runs differ; on a range of less than this share of the values they would be giants. */
const LEAST_SHARE = 0.02;
const UNLIMITED: Range = [Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY];

const colourOf = (i: number, scheme: Scheme) => TRACE_COLOURS[scheme][1 + (i % (TRACE_COLOURS[scheme].length - 1))];
const dashesOf = (i: number) => DASHES[i % DASHES.length];

/** Names of lines, where there are several to tell apart. */
export const lineEntries = (lines: readonly ChartLine[], scheme: Scheme): LegendEntry[] =>
  lines.length > 1 ? lines.map(({ name }, i) => ({ name, colour: colourOf(i, scheme), dashes: dashesOf(i) })) : [];

/** Lines over two titled axes. */
export function paintLines(
  pen: Pen,
  box: Box,
  { xLabel, yLabel, lines, xRange, yRange, yLimits = UNLIMITED }: LinesShown,
  look: Look,
): Plot {
  const across = xRange ?? spanOf(lines.flatMap((line) => line.x));
  const up = yRange ?? heightOf(lines, yLimits);
  const plot = paintAxes(pen, box, linearAxis(across, xLabel), linearAxis(up, yLabel), look);
  const { left, right, top, bottom } = plot.field;
  // a line along an edge of the field keeps its width
  within(pen, { left: left - 3, right: right + 3, top: top - 3, bottom: bottom + 3 }, () =>
    lines.forEach(({ x, y, spread, isStepped }, i) => {
      const colour = colourOf(i, look.scheme);
      paintLine(pen, plot, x, y, { colour, dashes: dashesOf(i) }, isStepped);
      if (spread || x.length === 1) paintPoints(pen, plot, x, y, colour, spread, yLimits);
    }),
  );
  return plot;
}

/** The range of lines with their bars, wide enough that bars are in proportion to the values. */
function heightOf(lines: readonly ChartLine[], [least, most]: Range): Range {
  const bars = lines.flatMap(({ y, spread }) =>
    y.map((v, i) => [Math.max(v - (spread?.[i] ?? 0), least), Math.min(v + (spread?.[i] ?? 0), most)]),
  );
  const [low, high] = spanOf(bars.flat());
  if (!lines.some(({ spread }) => spread)) return [low, high];
  const longest = bars.reduce((most, [from, to]) => Math.max(most, to - from), 0);
  const lacks = Math.max(LEAST_SHARE * Math.max(Math.abs(low), Math.abs(high)), 2 * longest) - (high - low);
  const wide: Range = lacks > 0 ? [low - lacks / 2, high + lacks / 2] : [low, high];
  const air = 0.04 * (wide[1] - wide[0]);
  return [Math.max(wide[0], least - air), Math.min(wide[1], most + air)];
}

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

/** What the point nearest to a place says, px. */
export function nearestPoint(
  lines: readonly ChartLine[],
  plot: Plot,
  at: { x: number; y: number },
): string | undefined {
  let best = REACH_PX;
  let found: string | undefined;
  for (const line of lines)
    line.x.forEach((x, i) => {
      const far = Math.hypot(plot.x(x) - at.x, plot.y(line.y[i]) - at.y);
      if (!(far < best)) return;
      best = far;
      const value = line.spread?.[i] ? formatSpread("", line.y[i], line.spread[i]) : formatShort(line.y[i], "");
      found = `${line.name ? `${line.name}: ` : ""}${formatShort(x, "")}, ${value}`;
    });
  return found;
}
