import { hypothesisWords } from "../../bench/hypothesis-words";
import { type Place, placeOn } from "../../picture/axes";
import type { Look, Pen } from "../../picture/pen";
import { fillHatched } from "../../picture/traces";
import { type PanelFrame, tickOf } from "../../stream/panel-frame";
import { formatCount, formatNumber, formatSi } from "../../ui/format";
import { CANVAS, fontFor, inkOn } from "../../ui/palette";
import type { TruthSwitch } from "./delays";
import type { LanesLayout } from "./lanes-layout";

const FITS_NONE = "fits none";
const NO_NAME = "none of these";

/** What every picture of lanes has: a span of time, the truth's changes in it, and where things lie. */
export interface LanesGround extends Look {
  frame: PanelFrame;
  span: { start: number; end: number };
  layout: LanesLayout;
  switches: TruthSwitch[];
}

/** Where ticks and columns lie. */
export function placesOf({ span, frame, layout }: LanesGround): { x: Place; columnX: Place } {
  const x = placeOn({ range: [span.start, span.end] }, layout.left, layout.right);
  return { x, columnX: (column) => x(tickOf(frame, column)) };
}

/** Stretches of an index signal as a band with names: solid for what is known, otherwise a guess. */
export function paintBand(
  ctx: Pen,
  stretches: ReturnType<typeof runs>,
  columnX: (c: number) => number,
  top: number,
  height: number,
  colour: (index: number) => string,
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
    if (solid || run.value < 0) {
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
    const needed = ctx.measureText(label).width;
    if (!solid) {
      ctx.fillStyle = colours.panel;
      ctx.fillRect(at - 4, top + 2, needed + 8, height - 4);
    }
    ctx.fillStyle = solid && run.value >= 0 ? inkOn(colour(run.value)) : colours.text;
    ctx.fillText(label, at, top + height / 2 + 0.5);
  }
}

/** Where no hypothesis fits: a bar under the verdict, which is only the least wrong one then. */
export function paintUnexplained(
  ctx: Pen,
  stretches: ReturnType<typeof runs>,
  columnX: (c: number) => number,
  picture: LanesGround,
): void {
  const { layout, scheme, fontSize } = picture;
  const colours = CANVAS[scheme];
  ctx.font = fontFor(fontSize - 1, 1, 650);
  ctx.textAlign = "right";
  for (const run of stretches) {
    if (run.value !== 1) continue;
    const left = Math.max(columnX(run.from), layout.left);
    const right = Math.min(columnX(run.to), layout.right);
    ctx.fillStyle = colours.alarm;
    ctx.fillRect(left, layout.winner + layout.band - 4, right - left, 4);
    const needed = ctx.measureText(FITS_NONE).width;
    if (right - left < 2.5 * needed) continue; // the verdict stands at the left
    ctx.fillStyle = colours.panel;
    ctx.fillRect(right - needed - 12, layout.winner, needed + 12, layout.band - 4);
    ctx.fillStyle = colours.alarm;
    ctx.fillText(FITS_NONE, right - 6, layout.winner + (layout.band - 4) / 2 + 0.5);
  }
}

/** The sample that is being explained: a line with a flag. */
export function paintPicked(
  ctx: Pen,
  tick: number | undefined,
  x: (tick: number) => number,
  bottom: number,
  colours: (typeof CANVAS)["dark"],
): void {
  if (tick === undefined) return;
  const at = Math.round(x(tick + 0.5));
  ctx.fillStyle = colours.text;
  ctx.fillRect(at - 1, 0, 2, bottom);
  ctx.beginPath();
  ctx.moveTo(at - 6, 0);
  ctx.lineTo(at + 6, 0);
  ctx.lineTo(at, 8);
  ctx.fill();
}

/** Between the truth's change and its recognition stands a bar; its length is the delay. */
export function paintDelays(ctx: Pen, picture: LanesGround, x: (tick: number) => number, winner: Float32Array): void {
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
export interface Run {
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
