import { paintColumns, timeAxis } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { fillSteps, within } from "../../picture/traces";
import { largest, lowest } from "../../stream/panel-frame";
import { CANVAS } from "../../ui/palette";
import type { TruthSwitch } from "./delays";
import type { LaneShown } from "./lane-canvas";
import type { LanesLayout } from "./lanes-layout";
import { inkOf, paintBand, paintDelays, paintMarks, placesOf, runs } from "./paint-bands";

export interface RaceShown extends LaneShown {
  switches: TruthSwitch[];
  names: string[];
  /** Whether the signals end with the index of the truth. */
  withTruth: boolean;
  /** How many of the signals are probabilities, which are stacked; the index of the verdict follows. */
  probabilities: number;
  picked: number | undefined;
}

/** The layout of one row of the race: probabilities, verdict, delay, truth. */
function rowLayout({ width, height }: Box, { fontSize }: Look): LanesLayout {
  const band = fontSize + 5;
  const truth = height - 7;
  const delay = truth - band - 1;
  const winner = delay - band;
  return { left: 0, right: width, lanes: [{ top: 2, height: winner - 4 }], winner, delay, truth, band, axis: height };
}

/** One diagnoser of the race: its probabilities as one filled field, its verdict, and its delay. */
export function paintRow(ctx: Pen, box: Box, shown: RaceShown, look: Look): void {
  const { frame, span, probabilities } = shown;
  const layout = rowLayout(box, look);
  const ground = { ...shown, ...look, layout };
  const colour = inkOf(look);
  const { columnX } = placesOf(ground);
  const field = { left: 0, right: layout.right, top: 0, bottom: layout.axis };
  // the head has the times
  within(ctx, field, () => paintColumns(ctx, field, timeAxis(span, frame.dtMs), look));
  ctx.textBaseline = "middle";

  const { top, height } = layout.lanes[0];
  const edges = stack(Array.from({ length: probabilities }, (_, i) => middle(lowest(frame, i), largest(frame, i))));
  // the last layer is drawn first and fills down to the axis; each earlier layer covers the lower part
  for (let i = edges.length - 1; i >= 0; i -= 1) {
    ctx.fillStyle = colour(i);
    fillSteps(ctx, edges[i], columnX, top + height, (edge) => Math.min(1, edge) * height);
  }
  const winner = lowest(frame, probabilities);
  paintBand(ctx, ground, winner, layout.winner, false, layout.band - 1);
  if (shown.withTruth) {
    for (const run of runs(largest(frame, probabilities + 1))) {
      ctx.fillStyle = run.value < 0 ? CANVAS[look.scheme].axis : colour(run.value);
      ctx.fillRect(columnX(run.from), layout.truth, columnX(run.to) - columnX(run.from), 6);
    }
  }
  paintDelays(ctx, ground, winner);
  paintMarks(ctx, ground);
}

/** The head of the race: the axis of time over the truth. */
export function paintHead(ctx: Pen, box: Box, shown: RaceShown, look: Look): void {
  const field = { left: 0, right: box.width, top: 0, bottom: 0 };
  paintColumns(ctx, field, timeAxis(shown.span, shown.frame.dtMs), look, [0, box.width]);
  paintTruth(ctx, box, shown, look, look.fontSize + 10);
}

/** The truth as a band; its index is the only signal. */
export function paintTruth(ctx: Pen, box: Box, shown: RaceShown, look: Look, top: number): void {
  ctx.textBaseline = "middle";
  paintBand(ctx, { ...shown, ...look, layout: rowLayout(box, look) }, largest(shown.frame, 0), top, true);
}

const middle = (low: Float32Array, high: Float32Array) => low.map((value, i) => 0.5 * (value + high[i]));

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
