import { paintColumns, timeAxis } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { within } from "../../picture/traces";
import { largest, lowest } from "../../stream/panel-frame";
import { CANVAS } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import type { TruthSwitch } from "./delays";
import type { LaneShown } from "./lane-canvas";
import type { LanesLayout } from "./lanes-layout";
import { paintBand, paintDelays, paintPicked, placesOf, runs } from "./paint-bands";

export interface RaceShown extends LaneShown {
  switches: TruthSwitch[];
  names: string[];
  /** Whether the signals end with the index of the truth. */
  withTruth: boolean;
  /** How many of the signals are probabilities, which are stacked; the index of the verdict follows. */
  probabilities: number;
  picked: number | undefined;
}

/** Where the parts of one row of the race lie: probabilities, verdict, delay, truth. */
function rowLayout({ width, height }: Box, { fontSize }: Look): LanesLayout {
  const band = fontSize + 5;
  const truth = height - 7;
  const delay = truth - band - 1;
  const winner = delay - band;
  return { left: 0, right: width, lanes: [{ top: 2, height: winner - 4 }], winner, delay, truth, band, axis: height };
}

/** One diagnoser of the race: what it believes as one filled field, what it says, and how long it took. */
export function paintRow(ctx: Pen, box: Box, shown: RaceShown, look: Look): void {
  const { frame, span, names, probabilities } = shown;
  const layout = rowLayout(box, look);
  const picture = { ...shown, ...look, layout };
  const colours = CANVAS[look.scheme];
  const colour = (i: number) => (i >= 0 ? traceColour(hypothesisStyle(i), look.scheme) : colours.muted);
  const { x, columnX } = placesOf(picture);
  const field = { left: 0, right: layout.right, top: 0, bottom: layout.axis };
  // the head says the times
  within(ctx, field, () => paintColumns(ctx, field, timeAxis(span, frame.dtMs), look));
  ctx.textBaseline = "middle";

  const { top, height } = layout.lanes[0];
  const edges = stack(Array.from({ length: probabilities }, (_, i) => middle(lowest(frame, i), largest(frame, i))));
  // the last layer is drawn first and fills down to the axis; each before it covers what lies below
  for (let i = edges.length - 1; i >= 0; i -= 1) {
    ctx.fillStyle = colour(i);
    ctx.beginPath();
    fillBelow(ctx, edges[i], columnX, top, height);
    ctx.fill();
  }
  const winner = lowest(frame, probabilities);
  paintBand(ctx, runs(winner), columnX, layout.winner, layout.band - 1, colour, names, colours, look.fontSize, false);
  if (shown.withTruth) {
    for (const run of runs(largest(frame, probabilities + 1))) {
      ctx.fillStyle = run.value < 0 ? colours.axis : colour(run.value);
      ctx.fillRect(columnX(run.from), layout.truth, columnX(run.to) - columnX(run.from), 6);
    }
  }
  paintDelays(ctx, picture, x, winner);
  paintPicked(ctx, shown.picked, x, layout.axis, colours);
  if (shown.hover !== undefined) {
    ctx.fillStyle = colours.accent;
    ctx.fillRect(Math.round(x(shown.hover)), 0, 1, layout.axis);
  }
}

/** The head of the race: the axis of time over what is true. */
export function paintHead(ctx: Pen, box: Box, shown: RaceShown, look: Look): void {
  const field = { left: 0, right: box.width, top: 0, bottom: 0 };
  paintColumns(ctx, field, timeAxis(shown.span, shown.frame.dtMs), look, [0, box.width]);
  paintTruth(ctx, box, shown, look, look.fontSize + 10);
}

/** What is true, as a band; its index is the only signal. */
export function paintTruth(ctx: Pen, box: Box, shown: RaceShown, look: Look, top: number): void {
  const layout = rowLayout(box, look);
  const colours = CANVAS[look.scheme];
  const colour = (i: number) => (i >= 0 ? traceColour(hypothesisStyle(i), look.scheme) : colours.muted);
  const { columnX } = placesOf({ ...shown, ...look, layout });
  ctx.textBaseline = "middle";
  const truth = runs(largest(shown.frame, 0));
  paintBand(ctx, truth, columnX, top, layout.band, colour, shown.names, colours, look.fontSize, true);
}

const middle = (low: Float32Array, high: Float32Array) => low.map((value, i) => 0.5 * (value + high[i]));

function fillBelow(ctx: Pen, edge: Float32Array, columnX: (c: number) => number, top: number, height: number): void {
  let from = -1;
  for (let c = 0; c <= edge.length; c += 1) {
    if (c < edge.length && Number.isNaN(edge[c])) continue;
    if (from >= 0) {
      const tall = Math.min(1, edge[from]) * height;
      ctx.rect(columnX(from), top + height - tall, columnX(c) - columnX(from), tall);
    }
    from = c;
  }
}

/** Upper edges of probabilities stacked on one another, column by column; together they fill the height. */
export function stack(layers: readonly Float32Array[]): Float32Array[] {
  const columns = layers[0]?.length ?? 0;
  const edges = layers.map(() => new Float32Array(columns));
  for (let c = 0; c < columns; c += 1) {
    let total = 0;
    for (const layer of layers) total += layer[c];
    let sum = 0;
    layers.forEach((layer, i) => {
      sum += layer[c] / total;
      edges[i][c] = sum;
    });
  }
  return edges;
}
