import type { Pen } from "../../picture/pen";
import { fontFor } from "../../ui/canvas-font";
import { formatSi } from "../../ui/format";
import { CANVAS, type Scheme, TRACE_COLOURS } from "../../ui/palette";
import { timeLabels, timeSplits, timeUnit } from "../../ui/time-axis";
import type { LanePainting } from "../lanes/lane-canvas";
import { columnAt } from "../scope/column-at";
import type { Strip } from "./adaptation-strips";
import { stripRange } from "./strip-range";

export const STRIP_PX = 54;
export const AXIS_PX = 22;
/** Right of the field, for the ends of the axes. */
export const RIGHT_PX = 58;

/** Pixels left of the field, for titles and numbers. */
export const gutter = (fontSize: number) => fontSize * 13;

/** Strips under one another: each an inner signal over time, dashed what it should be. */
export function paintStrips(
  ctx: Pen,
  painting: LanePainting,
  strips: readonly Strip[],
  columnOf: ReadonlyMap<string, number>,
  scheme: Scheme,
  fontSize: number,
  each: number = STRIP_PX,
): void {
  const { frame, span, width, height, hover } = painting;
  const colours = CANVAS[scheme];
  const left = gutter(fontSize);
  const right = width - RIGHT_PX;
  const x = (tick: number) => left + ((tick - span.start) / (span.end - span.start)) * (right - left);
  const columnX = (c: number) => x(frame.startTick + (c * (frame.endTick - frame.startTick)) / frame.columns);
  const part = (signal: number, which: number) =>
    frame.data.subarray((2 * signal + which) * frame.columns, (2 * signal + which + 1) * frame.columns);
  const reading = (signal: number) => (hover === undefined ? frame.latest[signal] : columnAt(frame, signal, hover));

  ctx.textBaseline = "middle";
  const bottom = height - AXIS_PX;
  const startMs = span.start * frame.dtMs;
  const endMs = span.end * frame.dtMs;
  const splits = timeSplits(startMs, endMs, Math.max(2, (right - left) / (fontSize * 8)));
  ctx.textAlign = "center";
  ctx.font = fontFor(fontSize, 1);
  timeLabels(splits, endMs - startMs).forEach((label, i) => {
    const at = x(splits[i] / frame.dtMs);
    ctx.fillStyle = colours.grid;
    ctx.fillRect(Math.round(at), 0, 1, bottom);
    ctx.fillStyle = colours.muted;
    ctx.fillText(label, at, bottom + AXIS_PX / 2);
  });
  ctx.textAlign = "right";
  ctx.fillText(timeUnit(endMs - startMs).unit, left - 8, bottom + AXIS_PX / 2);

  strips.forEach((strip, i) => {
    const top = i * each + 4;
    const tall = each - 10;
    const own = columnOf.get(strip.signal) ?? 0;
    const ideal = strip.ideal === undefined ? undefined : columnOf.get(strip.ideal);
    const rivals = (strip.rivals ?? []).map(({ signal, slot }) => ({ at: columnOf.get(signal) ?? 0, slot }));
    const shown = [own, ...(ideal === undefined ? [] : [ideal]), ...rivals.map((r) => r.at)];
    const seen = shown.flatMap((signal) => [part(signal, 0), part(signal, 1)]);
    const edges = strip.layer ? [Float32Array.of(-strip.layer, strip.layer)] : [];
    const [low, high] = stripRange(joined([...seen, ...edges]));
    const y = (value: number) => top + tall - ((value - low) / (high - low)) * tall;

    ctx.fillStyle = colours.axis;
    ctx.fillRect(left, top + tall + 3, right - left, 1);
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top - 2, right - left, tall + 5);
    ctx.clip();
    if (low < 0 && high > 0) {
      ctx.fillStyle = colours.grid;
      ctx.fillRect(left, Math.round(y(0)), right - left, 1);
    }
    if (strip.layer) {
      ctx.fillStyle = `${colours.accent}26`;
      ctx.fillRect(left, y(strip.layer), right - left, y(-strip.layer) - y(strip.layer));
    }
    if (ideal !== undefined) dashes(ctx, part(ideal, 1), columnX, y, TRACE_COLOURS[scheme][0]);
    for (const { at, slot } of [...rivals].reverse())
      envelope(ctx, part(at, 0), part(at, 1), columnX, y, TRACE_COLOURS[scheme][slot], undefined);
    const forbidden = strip.negative ? colours.alarm : undefined;
    envelope(ctx, part(own, 0), part(own, 1), columnX, y, TRACE_COLOURS[scheme][strip.slot ?? 1], forbidden);
    if (hover !== undefined) {
      ctx.fillStyle = colours.accent;
      ctx.fillRect(Math.round(x(hover)), top, 1, tall);
    }
    ctx.restore();

    ctx.textAlign = "left";
    ctx.font = fontFor(fontSize - 2, 1, 450);
    ctx.fillStyle = colours.muted;
    ctx.fillText(formatSi(high, strip.unit, 3), right + 6, top + 3);
    ctx.fillText(formatSi(low, strip.unit, 3), right + 6, top + tall - 3);

    const middle = top + tall / 2;
    ctx.textAlign = "left";
    ctx.font = fontFor(fontSize, 1, 560);
    ctx.fillStyle = colours.text;
    ctx.fillText(strip.title, 4, middle - fontSize * 0.75, left - 12);
    ctx.font = fontFor(fontSize, 1, 450);
    ctx.fillStyle = colours.muted;
    if (rivals.length > 0) return;
    const now = formatSi(reading(own), strip.unit, 3);
    ctx.fillText(
      ideal === undefined ? now : `${now} · ideal ${formatSi(reading(ideal), strip.unit, 3)}`,
      4,
      middle + fontSize * 0.75,
      left - 12,
    );
  });
}

function* joined(parts: readonly Float32Array[]): Generator<number> {
  for (const part of parts) yield* part;
}

function envelope(
  ctx: Pen,
  low: Float32Array,
  high: Float32Array,
  columnX: (c: number) => number,
  y: (value: number) => number,
  colour: string,
  forbidden: string | undefined,
): void {
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.6;
  ctx.lineJoin = "round";
  ctx.beginPath();
  for (let c = 0; c < low.length; c += 1) {
    if (Number.isNaN(low[c])) continue;
    ctx.lineTo(columnX(c), y(high[c]));
    if (low[c] !== high[c]) ctx.lineTo(columnX(c), y(low[c]));
    if (forbidden && high[c] > 0) {
      ctx.fillStyle = forbidden;
      ctx.fillRect(columnX(c) - 1, y(high[c]), 3, Math.max(2, y(0) - y(high[c])));
    }
  }
  ctx.stroke();
}

function dashes(
  ctx: Pen,
  values: Float32Array,
  columnX: (c: number) => number,
  y: (value: number) => number,
  colour: string,
): void {
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.4;
  ctx.setLineDash([5, 4]);
  ctx.beginPath();
  values.forEach((value, c) => {
    if (!Number.isNaN(value)) ctx.lineTo(columnX(c), y(value));
  });
  ctx.stroke();
  ctx.setLineDash([]);
}
