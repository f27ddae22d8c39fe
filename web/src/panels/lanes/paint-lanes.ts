import type { PanelFrame } from "../../stream/panel-frame";
import { fontFor } from "../../ui/canvas-font";
import { inkOn } from "../../ui/contrast";
import { formatNumber } from "../../ui/format";
import { hatch } from "../../ui/hatch";
import { CANVAS, type Scheme } from "../../ui/palette";
import { timeLabels, timeSplits, timeUnit } from "../../ui/time-axis";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { columnAt } from "../scope/column-at";
import type { TruthSwitch } from "./delays";
import type { LanesLayout } from "./lanes-layout";
import { runs } from "./runs";

export interface LanesPicture {
  frame: PanelFrame;
  span: { start: number; end: number };
  names: string[];
  layout: LanesLayout;
  scheme: Scheme;
  fontSize: number;
  switches: TruthSwitch[];
  hover: number | undefined;
}

/** Paint a bank: one filled lane per hypothesis, the guess hatched, the truth solid, the delay between them. */
export function paintLanes(ctx: CanvasRenderingContext2D, picture: LanesPicture): void {
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
    (i) => hatch(ctx, colour(i)),
    names,
    colours,
    fontSize,
    false,
  );
  paintBand(
    ctx,
    runs(column(names.length + 1, 1)),
    columnX,
    layout.truth,
    layout.band,
    colour,
    names,
    colours,
    fontSize,
    true,
  );
  paintDelays(ctx, picture, x, column(names.length, 0));
  if (picture.hover !== undefined) {
    ctx.fillStyle = colours.accent;
    ctx.fillRect(Math.round(x(picture.hover)), 0, 1, layout.axis);
  }
  ctx.restore();

  names.forEach((name, i) => {
    const { top, height } = layout.lanes[i];
    const y = top + height / 2;
    ctx.font = fontFor(fontSize, 1, i === truthNow ? 700 : 450);
    ctx.fillStyle = i === truthNow || i === winnerNow ? colours.text : colours.muted;
    ctx.textAlign = "right";
    ctx.fillText(name, layout.left - 10, y);
    ctx.font = fontFor(fontSize, 1, i === winnerNow ? 700 : 450);
    ctx.fillText(`${formatNumber(reading(i) * 100, 1)} %`, layout.right + fontSize * 4.4, y);
  });
  ctx.font = fontFor(fontSize, 1, 450);
  ctx.fillStyle = colours.muted;
  ctx.fillText("verdict", layout.left - 10, layout.winner + layout.band / 2);
  ctx.fillText("truth", layout.left - 10, layout.truth + layout.band / 2);
  ctx.fillText("delay", layout.left - 10, layout.delay + layout.band / 2);
}

function fillSteps(
  ctx: CanvasRenderingContext2D,
  values: Float32Array,
  columnX: (c: number) => number,
  base: number,
  tall: number,
): void {
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

function paintBand(
  ctx: CanvasRenderingContext2D,
  stretches: ReturnType<typeof runs>,
  columnX: (c: number) => number,
  top: number,
  height: number,
  fill: (index: number) => string | CanvasPattern,
  names: string[],
  colours: (typeof CANVAS)["dark"],
  fontSize: number,
  solid: boolean,
): void {
  ctx.font = fontFor(fontSize - 1, 1, 650);
  ctx.textAlign = "left";
  for (const run of stretches) {
    const left = columnX(run.from);
    const width = columnX(run.to) - left;
    ctx.fillStyle = run.value < 0 ? colours.axis : fill(run.value);
    ctx.fillRect(left, top, width, height);
    const label = names[run.value] ?? "none of these";
    const at = Math.max(left, columnX(0)) + 6;
    const needed = ctx.measureText(label).width;
    if (left + width - at < needed + 6) continue;
    if (!solid) {
      ctx.fillStyle = colours.panel;
      ctx.fillRect(at - 4, top + 2, needed + 8, height - 4);
    }
    ctx.fillStyle = solid && run.value >= 0 ? inkOn(String(fill(run.value))) : colours.text;
    ctx.fillText(label, at, top + height / 2 + 0.5);
  }
}

/** Between the truth's change and its recognition stands a bar; its length is the delay. */
function paintDelays(
  ctx: CanvasRenderingContext2D,
  picture: LanesPicture,
  x: (tick: number) => number,
  winner: Float32Array,
): void {
  const { layout, frame, switches, scheme, fontSize, span } = picture;
  const colours = CANVAS[scheme];
  const head = winner.length && !frame.frozen ? frame.endTick : span.end;
  ctx.font = fontFor(fontSize, 1, 600);
  ctx.textAlign = "left";
  switches.forEach((change, i) => {
    const next = switches[i + 1]?.tick ?? head;
    if (change.tick > span.end || next < span.start) return;
    const left = x(change.tick);
    ctx.fillStyle = colours.event;
    for (let y = 0; y < layout.axis; y += 6) ctx.fillRect(Math.round(left), y, 1, 3);
    const middle = layout.delay + layout.band / 2;
    if (!change.findable) {
      ctx.fillStyle = colours.muted;
      ctx.fillText("not among the hypotheses", Math.max(left, layout.left) + 6, middle + 0.5);
      return;
    }
    const found = change.delay === undefined ? next : change.tick + change.delay;
    ctx.fillStyle = change.delay === undefined ? colours.alarm : colours.accent;
    ctx.fillRect(left, middle - 3, Math.max(2, x(found) - left), 6);
    const at = Math.max(x(found), layout.left) + 6;
    const room = i + 1 < switches.length ? x(next) - at - 4 : Number.POSITIVE_INFINITY;
    const text = delayWords(change.delay, frame.dtMs).find((words) => ctx.measureText(words).width <= room);
    if (text) ctx.fillText(text, at, middle + 0.5);
  });
}

function paintTime(
  ctx: CanvasRenderingContext2D,
  { layout, span, frame, scheme, fontSize }: LanesPicture,
  x: (tick: number) => number,
): void {
  const colours = CANVAS[scheme];
  const startMs = span.start * frame.dtMs;
  const endMs = span.end * frame.dtMs;
  const splits = timeSplits(startMs, endMs, Math.max(2, (layout.right - layout.left) / (fontSize * 8)));
  const labels = timeLabels(splits, endMs - startMs);
  const y = layout.axis + fontSize / 2 + 4;
  ctx.font = fontFor(fontSize, 1);
  ctx.textAlign = "center";
  splits.forEach((ms, i) => {
    const at = x(ms / frame.dtMs);
    ctx.fillStyle = colours.grid;
    ctx.fillRect(Math.round(at), 0, 1, layout.axis);
    ctx.fillStyle = colours.muted;
    ctx.fillText(labels[i], at, y);
  });
  ctx.textAlign = "right";
  ctx.font = fontFor(fontSize, 1, 600);
  ctx.fillText(timeUnit(endMs - startMs).unit, layout.left - fontSize * 2.4, y);
}

/** A delay in words, the longest first; the picture takes what fits. */
function delayWords(delay: number | undefined, dtMs: number): string[] {
  if (delay === undefined) return ["not found yet", "not yet"];
  const ms = `${formatNumber(delay * dtMs, 2)} ms`;
  return [`${delay} samples · ${ms}`, `${delay} · ${ms}`, ms, String(delay)];
}
