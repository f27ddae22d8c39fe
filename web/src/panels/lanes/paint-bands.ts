import { hypothesisWords } from "../../bench/hypothesis-words";
import { type Place, placeOn } from "../../picture/axes";
import type { Look, Pen } from "../../picture/pen";
import { fillHatched } from "../../picture/traces";
import { tickOf } from "../../stream/panel-frame";
import { formatCount, formatNumber, formatSi } from "../../ui/format";
import { CANVAS, fontFor, inkOn } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import type { TruthSwitch } from "./delays";
import type { LaneShown } from "./lane-canvas";
import type { LanesLayout } from "./lanes-layout";

const FITS_NONE = "fits none";
const NO_NAME = "none of these";

/** The ground of every picture of lanes: a span of time, the changes of the truth in it, and the layout. */
interface LanesGround extends LaneShown, Look {
  layout: LanesLayout;
  switches: TruthSwitch[];
  names: string[];
  /** The sample that is explained. */
  picked: number | undefined;
}

/** The places of ticks and columns. */
export function placesOf({ span, frame, layout }: Pick<LanesGround, "span" | "frame" | "layout">) {
  const x = placeOn({ range: [span.start, span.end] }, layout.left, layout.right);
  const columnX: Place = (column) => x(tickOf(frame, column));
  return { x, columnX };
}

/** The colour of a hypothesis by its index; grey for none of them. */
export const inkOf =
  ({ scheme }: Pick<Look, "scheme">) =>
  (index: number): string =>
    index >= 0 ? traceColour(hypothesisStyle(index), scheme) : CANVAS[scheme].muted;

/** Stretches of an index signal as a band with names: solid for the truth, hatched for a guess. */
export function paintBand(
  ctx: Pen,
  ground: LanesGround,
  values: Float32Array,
  top: number,
  isSolid: boolean,
  height = ground.layout.band,
): void {
  const { scheme, fontSize, names } = ground;
  const colours = CANVAS[scheme];
  const colour = inkOf(ground);
  const { columnX } = placesOf(ground);
  ctx.font = fontFor(fontSize - 1, 1, 650);
  ctx.textAlign = "left";
  for (const run of runs(values)) {
    const left = columnX(run.from);
    const width = columnX(run.to) - left;
    if (isSolid || run.value < 0) {
      ctx.fillStyle = run.value < 0 ? colours.axis : colour(run.value);
      ctx.fillRect(left, top, width, height);
    } else fillHatched(ctx, left, top, width, height, colour(run.value));
    const name = names[run.value];
    const at = Math.max(left, columnX(0)) + 6;
    const room = left + width - at - 6;
    const label = (name === undefined ? [NO_NAME] : [hypothesisWords(name), name]).find(
      (words) => ctx.measureText(words).width <= room,
    );
    if (label === undefined) continue;
    if (!isSolid) {
      ctx.fillStyle = colours.panel;
      ctx.fillRect(at - 4, top + 2, ctx.measureText(label).width + 8, height - 4);
    }
    ctx.fillStyle = isSolid && run.value >= 0 ? inkOn(colour(run.value)) : colours.text;
    ctx.fillText(label, at, top + height / 2 + 0.5);
  }
}

/** Where no hypothesis fits: a bar under the verdict, which is only the least wrong one then. */
export function paintUnexplained(ctx: Pen, ground: LanesGround, values: Float32Array): void {
  const { layout, scheme, fontSize } = ground;
  const colours = CANVAS[scheme];
  const { columnX } = placesOf(ground);
  ctx.font = fontFor(fontSize - 1, 1, 650);
  ctx.textAlign = "right";
  for (const run of runs(values)) {
    if (run.value !== 1) continue;
    const left = Math.max(columnX(run.from), layout.left);
    const right = Math.min(columnX(run.to), layout.right);
    ctx.fillStyle = colours.alarm;
    ctx.fillRect(left, layout.winner + layout.band - 4, right - left, 4);
    const needed = ctx.measureText(FITS_NONE).width;
    if (right - left < 2.5 * needed) continue; // the verdict is at the left
    ctx.fillStyle = colours.panel;
    ctx.fillRect(right - needed - 12, layout.winner, needed + 12, layout.band - 4);
    ctx.fillStyle = colours.alarm;
    ctx.fillText(FITS_NONE, right - 6, layout.winner + (layout.band - 4) / 2 + 0.5);
  }
}

/** The explained sample as a line with a flag, and the tick under the pointer as a line. */
export function paintMarks(ctx: Pen, ground: LanesGround): void {
  const { picked, hover, layout, scheme } = ground;
  const { x } = placesOf(ground);
  if (picked !== undefined) {
    const at = Math.round(x(picked + 0.5));
    ctx.fillStyle = CANVAS[scheme].text;
    ctx.fillRect(at - 1, 0, 2, layout.axis);
    ctx.beginPath();
    ctx.moveTo(at - 6, 0);
    ctx.lineTo(at + 6, 0);
    ctx.lineTo(at, 8);
    ctx.fill();
  }
  if (hover === undefined) return;
  ctx.fillStyle = CANVAS[scheme].accent;
  ctx.fillRect(Math.round(x(hover)), 0, 1, layout.axis);
}

/** A bar from each change of the truth to its recognition; its length is the delay. */
export function paintDelays(ctx: Pen, ground: LanesGround, winner: Float32Array): void {
  const { layout, frame, switches, scheme, fontSize, span } = ground;
  const { x } = placesOf(ground);
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
    const found = !change.findable ? change.tick : change.delay === undefined ? next : change.tick + change.delay;
    ctx.fillStyle = !change.findable ? colours.muted : change.delay === undefined ? colours.alarm : colours.accent;
    if (change.findable) ctx.fillRect(left, middle - 3, Math.max(2, x(found) - left), 6);
    const at = Math.max(x(found), layout.left) + 6;
    const room = Math.min(layout.right, i + 1 < switches.length ? x(next) - 4 : layout.right) - at;
    const text = delayWords(change, frame.dtMs).find((words) => ctx.measureText(words).width <= room);
    if (text) ctx.fillText(text, at, middle + 0.5);
  });
}

/** A delay in words, the longest first; the picture takes what fits. */
function delayWords({ delay, findable, isStartUp }: TruthSwitch, dtMs: number): string[] {
  if (!findable) return ["not among the hypotheses", "not among them", "none"];
  if (delay === undefined) return ["not found yet", "not yet"];
  if (delay === 0) return ["said before", "before"];
  const time = formatSi(delay * dtMs, "ms", 3);
  if (isStartUp) return [`start-up ${time}`, time];
  return [
    `${formatCount(delay, "sample")} · ${time}`,
    `${formatNumber(delay, 0)} · ${time}`,
    time,
    formatNumber(delay, 0),
  ];
}

/** A stretch of columns over which an index signal keeps one value. */
interface Run {
  value: number;
  from: number;
  /** One past the last column. */
  to: number;
}

/** Stretches of equal value; columns without data belong to the stretch before them. */
export function runs(values: Float32Array): Run[] {
  const found: Run[] = [];
  for (let c = 0; c < values.length; c += 1) {
    const value = values[c];
    const last = found.at(-1);
    if (Number.isNaN(value)) {
      if (last) last.to = c + 1;
    } else if (last && last.value === value) last.to = c + 1;
    else found.push({ value, from: c, to: c + 1 });
  }
  return found;
}
