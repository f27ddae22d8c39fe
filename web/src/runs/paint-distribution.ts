import type { Distribution } from "../api/types";
import { linearAxis, type Plot, paintAxes } from "../picture/axes";
import type { Box, Look, Pen } from "../picture/pen";
import { paintDot } from "../picture/traces";
import { formatCount, formatShort } from "../ui/format";
import type { MetricScale } from "../ui/metric-name";
import { rampColour, TRACE_COLOURS } from "../ui/palette";

/** The runs to paint, over one quantity or two, and the scales of these. */
export interface Shown {
  found: Distribution;
  x: MetricScale;
  y: MetricScale | undefined;
}

/** The place of a number of runs on the logarithmic scale of colours. */
export const shareOf = (count: number, most: number): number => (most > 1 ? Math.log(count) / Math.log(most) : 1);

/** The most runs in one cell. */
export const mostIn = ({ counts }: Distribution): number => counts.flat().reduce((a, b) => Math.max(a, b), 0);

/** A histogram, dots, or cells whose colour says how many runs they hold. */
export function paintDistribution(pen: Pen, box: Box, { found, x, y }: Shown, look: Look): Plot {
  const colour = TRACE_COLOURS[look.scheme][1];
  const across = linearAxis([x.shown(found.x.low), x.shown(found.x.high)], x.title);
  const most = mostIn(found);
  const up =
    found.y && y
      ? linearAxis([y.shown(found.y.low), y.shown(found.y.high)], y.title)
      : linearAxis([0, most * 1.05 || 1], "runs");
  const plot = paintAxes(pen, box, across, up, look);
  const { left, right, top, bottom } = plot.field;
  if (found.dots && y) {
    for (const [at, height] of found.dots) paintDot(pen, plot.x(x.shown(at)), plot.y(y.shown(height)), 2, colour);
    return plot;
  }
  const wide = (right - left) / found.x.cells;
  const edge = (column: number) => Math.round(left + column * wide);
  if (!found.y) {
    pen.fillStyle = colour;
    found.counts[0].forEach((count, column) => {
      const height = Math.round(plot.y(count));
      if (count > 0)
        pen.fillRect(edge(column), height, Math.max(1, edge(column + 1) - edge(column) - 1), bottom - height);
    });
    return plot;
  }
  const tall = (bottom - top) / found.y.cells;
  found.counts.forEach((row, i) => {
    const from = Math.round(bottom - (i + 1) * tall);
    const to = Math.round(bottom - i * tall);
    row.forEach((count, column) => {
      if (count === 0) return;
      pen.fillStyle = rampColour(shareOf(count, most), look.scheme);
      pen.fillRect(edge(column), from, edge(column + 1) - edge(column), to - from);
    });
  });
  return plot;
}

/** From where to where the quantities reach, in words. */
export function extentText({ found, x, y }: Shown): string {
  const part = ({ low, high }: Distribution["x"], scale: MetricScale) => rangeText(scale, low, high);
  return [part(found.x, x), ...(found.y && y ? [part(found.y, y)] : [])].join(", ");
}

function rangeText(scale: MetricScale, low: number, high: number): string {
  const [from, to] = [low, high].map((value) => formatShort(scale.shown(value), "", 4));
  return `${scale.name} ${from} to ${to}${scale.unit && `\u00a0${scale.unit}`}`;
}

/** The cell under the pointer, in words. */
export function cellText({ found, x, y }: Shown, { field }: Plot, at: { x: number; y: number }): string | undefined {
  const column = Math.floor(((at.x - field.left) / (field.right - field.left)) * found.x.cells);
  const row = found.y ? Math.floor(((field.bottom - at.y) / (field.bottom - field.top)) * found.y.cells) : 0;
  const count = found.counts[row]?.[column];
  if (count === undefined) return undefined;
  const part = (extent: Distribution["x"], scale: MetricScale, cell: number) => {
    const edge = (n: number) => extent.low + ((extent.high - extent.low) * n) / extent.cells;
    return rangeText(scale, edge(cell), edge(cell + 1));
  };
  const where = [part(found.x, x, column), ...(found.y && y ? [part(found.y, y, row)] : [])];
  return `${where.join(", ")}: ${formatCount(count, "run")}`;
}
