import type { CampaignPicture } from "../api/types";
import { type Axis, linearAxis, type Plot, paintAxes, paintRows, type Range } from "../picture/axes";
import type { Box, Look, Pen } from "../picture/pen";
import type { MetricScale } from "../ui/metric-name";
import { rampColour } from "../ui/palette";
import { labelScale, labelText } from "./points";

export type Part = CampaignPicture["parts"][number];

/** A figure over two numbers: the values of each, in their order, and the place of each point among them. */
interface MapShown {
  part: Part;
  x: MetricScale;
  y: MetricScale;
  columns: number[];
  rows: number[];
  figure: MetricScale;
  /** Of the colours, in the unit of the figure. */
  span: Range;
}

/** Of the scale of colours, px. */
const BAR = 12;
const BESIDE = 72;
const STEPS = 48;

/** A part of a picture as a map. */
export function mapOf({ across, up, low, high }: CampaignPicture, part: Part, figure: MetricScale): MapShown {
  const ascending = (values: readonly number[]) => [...new Set(values)].sort((a, b) => a - b);
  return {
    part,
    x: labelScale(across, part.x),
    y: labelScale(up, part.y),
    columns: ascending(part.x),
    rows: ascending(part.y),
    figure,
    span: [figure.shown(low), figure.shown(high)],
  };
}

/** Cells whose colour is the figure, with the scale of the colours; pairs without a figure stay blank. */
export function paintMap(pen: Pen, box: Box, shown: MapShown, look: Look): Plot {
  const { part, columns, rows, figure, span } = shown;
  const across = valueAxis(columns, shown.x);
  const up = valueAxis(rows, shown.y);
  const plot = paintAxes(pen, { ...box, width: box.width - BESIDE }, across, up, look);
  const { left, right, top, bottom } = plot.field;
  const colours = linearAxis(span);
  const share = (value: number) => (value - span[0]) / (span[1] - span[0]);
  part.mean.forEach((mean, i) => {
    const [column, row] = [columns.indexOf(part.x[i]), rows.indexOf(part.y[i])];
    const [from, to] = [Math.round(plot.x(column)), Math.round(plot.x(column + 1))];
    const [upper, lower] = [Math.round(plot.y(row + 1)), Math.round(plot.y(row))];
    pen.fillStyle = rampColour(share(figure.shown(mean)), look.scheme);
    pen.fillRect(from, upper, to - from, lower - upper);
  });
  const bar = right + BAR;
  const edge = (step: number) => Math.round(bottom - (step / STEPS) * (bottom - top));
  for (let step = 0; step < STEPS; step += 1) {
    pen.fillStyle = rampColour((step + 0.5) / STEPS, look.scheme);
    pen.fillRect(bar, edge(step + 1), BAR, edge(step) - edge(step + 1));
  }
  paintRows(pen, { left, right, top, bottom }, colours, look, bar + BAR);
  return plot;
}

/** Which point is under the pointer. */
export function pointAt({ part, columns, rows }: MapShown, { field }: Plot, at: { x: number; y: number }) {
  const column = Math.floor(((at.x - field.left) / (field.right - field.left)) * columns.length);
  const row = Math.floor(((field.bottom - at.y) / (field.bottom - field.top)) * rows.length);
  const found = part.mean.findIndex((_, i) => part.x[i] === columns[column] && part.y[i] === rows[row]);
  return found < 0 ? undefined : found;
}

/** An axis with equal places for all values. */
function valueAxis(values: readonly number[], scale: MetricScale): Axis {
  return {
    range: [0, values.length],
    title: scale.title,
    ticks: (count) => {
      const every = Math.ceil(values.length / Math.max(1, count));
      return values.flatMap((_, i) => (i % every ? [] : [i + 0.5]));
    },
    say: (ticks) => ticks.map((tick) => labelText(values[Math.floor(tick)], scale.shown)),
  };
}
