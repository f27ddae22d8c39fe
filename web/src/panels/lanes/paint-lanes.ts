import type { Pen } from "../../picture/pen";
import { fontFor } from "../../ui/canvas-font";
import { formatPercent } from "../../ui/format";
import { CANVAS } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { columnAt } from "../scope/column-at";
import { type LanesGround, paintBand, paintDelays, paintPicked, paintTime, paintUnexplained } from "./paint-bands";
import { runs } from "./runs";

export interface LanesPicture extends LanesGround {
  names: string[];
  /** What the lanes are called: the hypotheses in words, or by name where words have no room. */
  labels: string[];
  hover: number | undefined;
  /** Whether the signals end with what says that no hypothesis fits. */
  withUnexplained: boolean;
  /** The sample that is being explained. */
  picked: number | undefined;
}

/** Paint a bank: one filled lane per hypothesis, the guess hatched, the truth solid, the delay between them. */
export function paintLanes(ctx: Pen, picture: LanesPicture): void {
  const { frame, span, names, layout, scheme, fontSize } = picture;
  const colours = CANVAS[scheme];
  const colour = (i: number) => (i >= 0 ? traceColour(hypothesisStyle(i), scheme) : colours.muted);
  const x = (tick: number) =>
    layout.left + ((tick - span.start) / (span.end - span.start)) * (layout.right - layout.left);
  const perColumn = (frame.endTick - frame.startTick) / frame.columns;
  const columnX = (c: number) => x(frame.startTick + c * perColumn);
  const column = (signal: number, part: number) =>
    frame.data.subarray((signal * 2 + part) * frame.columns, (signal * 2 + part + 1) * frame.columns);
  const reading = (signal: number) =>
    picture.hover === undefined ? frame.latest[signal] : columnAt(frame, signal, picture.hover);
  const winnerNow = reading(names.length);
  const truthNow = reading(names.length + 1);

  ctx.textBaseline = "middle";
  paintTime(ctx, picture, x);

  ctx.save();
  ctx.beginPath();
  ctx.rect(layout.left, 0, layout.right - layout.left, layout.axis);
  ctx.clip();
  names.forEach((_, i) => {
    const { top, height } = layout.lanes[i];
    const base = top + height - 2;
    const tall = height - 4;
    for (const [part, alpha] of [
      [1, "66"],
      [0, "d9"],
    ] as const) {
      ctx.fillStyle = colour(i) + alpha;
      ctx.beginPath();
      fillSteps(ctx, column(i, part), columnX, base, tall);
      ctx.fill();
    }
    ctx.fillStyle = colours.axis;
    ctx.fillRect(layout.left, base, layout.right - layout.left, 1);
  });
  paintBand(
    ctx,
    runs(column(names.length, 1)),
    columnX,
    layout.winner,
    layout.band,
    colour,
    names,
    colours,
    fontSize,
    false,
  );
  if (picture.withUnexplained) paintUnexplained(ctx, runs(column(names.length + 2, 1)), columnX, picture);
  const truth = runs(column(names.length + 1, 1));
  paintBand(ctx, truth, columnX, layout.truth, layout.band, colour, names, colours, fontSize, true);
  paintDelays(ctx, picture, x, column(names.length, 0));
  paintPicked(ctx, picture.picked, x, layout.axis, colours);
  if (picture.hover !== undefined) {
    ctx.fillStyle = colours.accent;
    ctx.fillRect(Math.round(x(picture.hover)), 0, 1, layout.axis);
  }
  ctx.restore();

  names.forEach((_, i) => {
    const { top, height } = layout.lanes[i];
    const y = top + height / 2;
    ctx.font = fontFor(fontSize, 1, i === truthNow ? 700 : 450);
    ctx.fillStyle = i === truthNow || i === winnerNow ? colours.text : colours.muted;
    ctx.textAlign = "right";
    ctx.fillText(picture.labels[i], layout.left - 10, y);
    ctx.font = fontFor(fontSize, 1, i === winnerNow ? 700 : 450);
    ctx.fillText(formatPercent(reading(i)), layout.right + fontSize * 6, y);
  });
  ctx.font = fontFor(fontSize, 1, 450);
  ctx.fillStyle = colours.muted;
  ctx.fillText("verdict", layout.left - 10, layout.winner + layout.band / 2);
  ctx.fillText("truth", layout.left - 10, layout.truth + layout.band / 2);
  ctx.fillText("delay", layout.left - 10, layout.delay + layout.band / 2);
}

function fillSteps(ctx: Pen, values: Float32Array, columnX: (c: number) => number, base: number, tall: number): void {
  let from = -1;
  let height = 0;
  for (let c = 0; c < values.length; c += 1) {
    const value = values[c];
    if (Number.isNaN(value)) continue;
    if (from >= 0) ctx.rect(columnX(from), base - height, columnX(c) - columnX(from), height);
    from = c;
    height = Math.max(1, value * tall);
  }
  if (from >= 0) ctx.rect(columnX(from), base - height, columnX(values.length) - columnX(from), height);
}
