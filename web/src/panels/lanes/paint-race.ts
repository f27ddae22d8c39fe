import type { Pen } from "../../picture/pen";
import { CANVAS } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import type { LanesLayout } from "./lanes-layout";
import { type LanesGround, paintBand, paintDelays, paintPicked, paintTime } from "./paint-bands";
import { runs } from "./runs";
import { stack } from "./stack";

export interface RacePicture extends LanesGround {
  names: string[];
  /** Whether the signals end with the index of the truth. */
  withTruth: boolean;
  /** How many of the signals are probabilities, which are stacked; the index of the verdict follows. */
  probabilities: number;
  hover: number | undefined;
  picked: number | undefined;
}

/** Where the parts of one row of the race lie: probabilities, verdict, delay, truth. */
export function rowLayout(width: number, height: number, fontSize: number): LanesLayout {
  const band = fontSize + 5;
  const truth = height - 7;
  const delay = truth - band - 1;
  const winner = delay - band;
  return { left: 0, right: width, lanes: [{ top: 2, height: winner - 4 }], winner, delay, truth, band, axis: height };
}

/** One diagnoser of the race: what it believes as one filled field, what it says, and how long it took. */
export function paintRow(ctx: Pen, picture: RacePicture): void {
  const { frame, span, layout, scheme, names, probabilities } = picture;
  const colours = CANVAS[scheme];
  const colour = (i: number) => (i >= 0 ? traceColour(hypothesisStyle(i), scheme) : colours.muted);
  const x = (tick: number) => ((tick - span.start) / (span.end - span.start)) * layout.right;
  const perColumn = (frame.endTick - frame.startTick) / frame.columns;
  const columnX = (c: number) => x(frame.startTick + c * perColumn);
  const low = (signal: number) => column(picture, signal, 0);
  const high = (signal: number) => column(picture, signal, 1);
  ctx.textBaseline = "middle";
  paintGrid(ctx, picture, x);

  const { top, height } = layout.lanes[0];
  const edges = stack(Array.from({ length: probabilities }, (_, i) => middle(low(i), high(i))));
  // the last layer is drawn first and fills down to the axis; each before it covers what lies below
  for (let i = edges.length - 1; i >= 0; i -= 1) {
    ctx.fillStyle = colour(i);
    ctx.beginPath();
    fillBelow(ctx, edges[i], columnX, top, height);
    ctx.fill();
  }
  const winner = low(probabilities);
  paintBand(
    ctx,
    runs(winner),
    columnX,
    layout.winner,
    layout.band - 1,
    colour,
    names,
    colours,
    picture.fontSize,
    false,
  );
  if (picture.withTruth) {
    for (const run of runs(high(probabilities + 1))) {
      ctx.fillStyle = run.value < 0 ? colours.axis : colour(run.value);
      ctx.fillRect(columnX(run.from), layout.truth, columnX(run.to) - columnX(run.from), 6);
    }
  }
  paintDelays(ctx, picture, x, winner);
  paintPicked(ctx, picture.picked, x, layout.axis, colours);
  if (picture.hover !== undefined) {
    ctx.fillStyle = colours.accent;
    ctx.fillRect(Math.round(x(picture.hover)), 0, 1, layout.axis);
  }
}

/** The head of the race: the axis of time over what is true. */
export function paintHead(ctx: Pen, picture: RacePicture): void {
  const { span, layout } = picture;
  const x = (tick: number) => ((tick - span.start) / (span.end - span.start)) * layout.right;
  ctx.textBaseline = "middle";
  paintTime(ctx, { ...picture, layout: { ...layout, axis: 0 } }, x);
  paintTruth(ctx, picture);
}

/** What is true, as a band; its index is the only signal. */
export function paintTruth(ctx: Pen, picture: RacePicture): void {
  const { frame, span, layout, scheme, names, fontSize } = picture;
  const colours = CANVAS[scheme];
  const x = (tick: number) => ((tick - span.start) / (span.end - span.start)) * layout.right;
  const perColumn = (frame.endTick - frame.startTick) / frame.columns;
  ctx.textBaseline = "middle";
  paintBand(
    ctx,
    runs(column(picture, 0, 1)),
    (c) => x(frame.startTick + c * perColumn),
    layout.truth,
    layout.band,
    (i) => (i >= 0 ? traceColour(hypothesisStyle(i), scheme) : colours.muted),
    names,
    colours,
    fontSize,
    true,
  );
}

function column({ frame }: RacePicture, signal: number, part: number): Float32Array {
  return frame.data.subarray((signal * 2 + part) * frame.columns, (signal * 2 + part + 1) * frame.columns);
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

function paintGrid(ctx: Pen, picture: RacePicture, x: (tick: number) => number): void {
  ctx.save();
  ctx.beginPath();
  ctx.rect(0, 0, picture.layout.right, picture.layout.axis);
  ctx.clip();
  paintTime(ctx, picture, x);
  ctx.restore();
}
