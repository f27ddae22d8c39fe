import { paintColumns, placeOn, timeAxis } from "../../picture/axes";
import { eventAxis } from "../../picture/event-marks";
import type { LegendEntry } from "../../picture/legend";
import type { Box, Field, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { strokeEnvelope, within } from "../../picture/traces";
import { columnAt, largest, lowest, tickOf } from "../../stream/panel-frame";
import { formatSi } from "../../ui/format";
import { CANVAS, fontFor, TRACE_COLOURS } from "../../ui/palette";
import { linearTicks } from "../../ui/ticks";
import type { LaneShown } from "../lanes/lane-canvas";
import { type Strip, signalsOf } from "./adaptation-strips";

export const STRIP_PX = 54;
export const AXIS_PX = 22;
/** Right of the field, for the ends of the axes. */
export const RIGHT_PX = 58;
/** Of a strip in a picture that is kept. */
const PRINTED_PX = 84;
const IDEAL_DASHES = [5, 4];

/** Pixels left of the field, for titles and numbers. */
export const gutter = (fontSize: number) => fontSize * 13;

const fieldOf = ({ width, height }: Box, { fontSize }: Look): Field => ({
  left: gutter(fontSize),
  right: width - RIGHT_PX,
  top: 0,
  bottom: height - AXIS_PX,
});

/** Strips under one another: in each an inner signal over time, and dashed its ideal value. */
export function paintStrips(pen: Pen, box: Box, shown: LaneShown, strips: readonly Strip[], look: Look): void {
  const field = fieldOf(box, look);
  const each = field.bottom / strips.length;
  const columnOf = new Map(strips.flatMap(signalsOf).map((name, i) => [name, i]));
  paintColumns(pen, field, timeAxis(shown.span, shown.frame.dtMs), look);
  strips.forEach((strip, i) => {
    paintStrip(pen, { ...field, top: i * each + 4, bottom: (i + 1) * each - 6 }, shown, strip, columnOf, look);
  });
}

function paintStrip(
  pen: Pen,
  field: Field,
  { frame, span, hover }: LaneShown,
  strip: Strip,
  columnOf: ReadonlyMap<string, number>,
  { scheme, fontSize }: Look,
): void {
  const ink = CANVAS[scheme];
  const colours = TRACE_COLOURS[scheme];
  const { left, right, top, bottom } = field;
  const wide = right - left;
  const own = columnOf.get(strip.signal) ?? 0;
  const ideal = strip.ideal === undefined ? undefined : columnOf.get(strip.ideal);
  const rivals = (strip.rivals ?? []).map(({ signal, slot }) => ({ at: columnOf.get(signal) ?? 0, slot }));
  const drawn = [own, ...(ideal === undefined ? [] : [ideal]), ...rivals.map((r) => r.at)];
  const seen = drawn.flatMap((signal) => [lowest(frame, signal), largest(frame, signal)]);
  const edges = strip.layer ? [Float32Array.of(-strip.layer, strip.layer)] : [];
  const range = stripRange(joined([...seen, ...edges]));
  const y = placeOn({ range }, bottom, top);
  const at = placeOn({ range: [span.start, span.end] }, left, right);
  const x = (column: number) => at(tickOf(frame, column));
  const trace = (signal: number, slot: number) => {
    const envelope = { low: lowest(frame, signal), high: largest(frame, signal) };
    strokeEnvelope(pen, { x, y }, envelope, { colour: colours[slot], width: 1.6 });
  };

  pen.fillStyle = ink.axis;
  pen.fillRect(left, bottom + 3, wide, 1);
  within(pen, { left, right, top: top - 2, bottom: bottom + 3 }, () => {
    pen.fillStyle = ink.grid;
    if (range[0] < 0 && range[1] > 0) pen.fillRect(left, Math.round(y(0)), wide, 1);
    pen.fillStyle = `${ink.accent}26`;
    if (strip.layer) pen.fillRect(left, y(strip.layer), wide, y(-strip.layer) - y(strip.layer));
    if (ideal !== undefined) {
      const flat = largest(frame, ideal);
      const stroke = { colour: colours[0], width: 1.4, dashes: IDEAL_DASHES };
      strokeEnvelope(pen, { x, y }, { low: flat, high: flat }, stroke);
    }
    for (const rival of [...rivals].reverse()) trace(rival.at, rival.slot);
    trace(own, strip.slot ?? 1);
    if (strip.negative) paintForbidden(pen, largest(frame, own), x, y, ink.alarm);
    pen.fillStyle = ink.accent;
    if (hover !== undefined) pen.fillRect(Math.round(at(hover)), top, 1, bottom - top);
  });

  pen.textAlign = "left";
  pen.textBaseline = "middle";
  pen.font = fontFor(fontSize - 2, 1);
  pen.fillStyle = ink.muted;
  pen.fillText(formatSi(range[1], strip.unit, 3), right + 6, top + 3);
  pen.fillText(formatSi(range[0], strip.unit, 3), right + 6, bottom - 3);
  const middle = (top + bottom) / 2;
  pen.font = fontFor(fontSize, 1, 560);
  pen.fillStyle = ink.text;
  pen.fillText(strip.title, 4, middle - fontSize * 0.75, left - 12);
  if (rivals.length > 0) return;
  const say = (signal: number) =>
    formatSi(hover === undefined ? frame.latest[signal] : columnAt(frame, signal, hover), strip.unit, 3);
  pen.font = fontFor(fontSize, 1);
  pen.fillStyle = ink.muted;
  const words = ideal === undefined ? say(own) : `${say(own)} · ideal ${say(ideal)}`;
  pen.fillText(words, 4, middle + fontSize * 0.75, left - 12);
}

/** Values above zero, which theory forbids, as bars down to zero. */
function paintForbidden(
  pen: Pen,
  high: Float32Array,
  x: (column: number) => number,
  y: (value: number) => number,
  alarm: string,
): void {
  pen.fillStyle = alarm;
  high.forEach((value, c) => {
    if (value > 0) pen.fillRect(x(c) - 1, y(value), 3, Math.max(2, y(0) - y(value)));
  });
}

/** Ends of the axis of a strip: whole ticks around every value, so that it moves seldom. */
export function stripRange(values: Iterable<number>): [number, number] {
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return [-1, 1];
  const middle = 0.5 * (low + high);
  const half = Math.max(0.5 * (high - low), Math.abs(middle) * 1e-3, 1e-30) * 1.15;
  const ticks = linearTicks(middle - 2 * half, middle + 2 * half, 16);
  return [
    ticks.filter((t) => t <= middle - half).at(-1) ?? middle - half,
    ticks.find((t) => t >= middle + half) ?? middle + half,
  ];
}

function* joined(parts: readonly Float32Array[]): Generator<number> {
  for (const part of parts) yield* part;
}

/** Strips as a picture; each has its title on the left and the ends of its axis, with the unit, on the right. */
export const stripsPicture = (
  shown: LaneShown,
  strips: readonly Strip[],
  what: string,
  traces: readonly { name: string; slot: number }[],
): Picture => ({
  ...pictureName(what),
  legend: [
    ...traces.map(({ name, slot }): LegendEntry => ({ name, colour: TRACE_COLOURS.light[slot] })),
    { name: "ideal", colour: TRACE_COLOURS.light[0], dashes: IDEAL_DASHES },
  ],
  height: strips.length * PRINTED_PX + AXIS_PX,
  time: eventAxis(shown, fieldOf),
  paint: (pen, box, look) => paintStrips(pen, box, { ...shown, hover: undefined }, strips, look),
});
