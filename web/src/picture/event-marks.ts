import type { LogEntry } from "../api/types";
import { eventTone } from "../bench/flag-words";
import { type Marks, marksNow } from "../bench/marks";
import type { PanelFrame } from "../stream/panel-frame";
import { formatMoment } from "../ui/format";
import { CANVAS, fontFor } from "../ui/palette";
import { timeUnit } from "../ui/time-axis";
import { placeOn } from "./axes";
import type { Box, Field, Look, Pen } from "./pen";
import { paintRule } from "./traces";

/** An axis of device time with its events. */
export interface EventAxis {
  /** Ticks shown. */
  span: { start: number; end: number };
  dtMs: number;
  /** Tick that the axis calls zero. */
  origin?: number;
  isTriggered?: boolean;
  marks: Marks;
  /** The field of the axis in a plot of a size. */
  field(box: Box, look: Look): Field;
}

/** The axis of a frame of device time, with the events of the bench. */
export const eventAxis = (
  { frame, span }: { frame: PanelFrame; span: { start: number; end: number } },
  fieldOf: (box: Box, look: Look) => Field,
): EventAxis => ({ span, dtMs: frame.dtMs, marks: marksNow(), field: fieldOf });

const INK = CANVAS.light;
const LINE = 18;
const MOST = 12;
/** What follows this closely, in pixels, has no room for its own words: the first event speaks. */
const NEAR = 8;

export const timeTitle = ({ span, dtMs, isTriggered }: EventAxis) =>
  `${isTriggered ? "time from the trigger" : "time of the device"}, ${timeUnit((span.end - span.start) * dtMs).unit}`;

/** The events in sight that speak. */
export const eventsWithin = ({ marks, span }: Pick<EventAxis, "marks" | "span">): LogEntry[] =>
  marks.events.filter((e) => e.tick >= span.start && e.tick <= span.end && eventTone(e) !== "quiet");

/**
 * Events as lines over a plot, faults as bands along its top. Above a line are the words of the event, after the line or
 * before it; where neither has room, they cover the words of the next event. Events without words have numbers, which join into a range
 * where they have no room.
 */
export function markEvents(
  pen: Pen,
  { span, marks }: Pick<EventAxis, "span" | "marks">,
  { left, right, top, bottom }: Field,
  { scheme, fontSize }: Look,
  say?: (event: LogEntry) => string,
): void {
  const ink = CANVAS[scheme];
  const x = placeOn({ range: [span.start, span.end] }, left, right);
  pen.fillStyle = ink.alarm;
  for (const fault of marks.faults) {
    if (fault.start > span.end || (fault.end ?? span.end) < span.start) continue;
    const from = x(Math.max(fault.start, span.start));
    pen.fillRect(from, top - 4, x(Math.min(fault.end ?? span.end, span.end)) - from, 4);
  }
  pen.font = fontFor(fontSize - 1, 1, 600);
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  const events = eventsWithin({ marks, span });
  const labels: { left: number; right: number; text: string; colour: string; event: LogEntry; at: number }[] = [];
  const width = (text: string) => pen.measureText(text).width;
  for (const [i, event] of events.entries()) {
    const at = x(event.tick);
    const tone = eventTone(event);
    const colour = tone === "alarm" ? ink.alarm : tone === "found" ? ink.accent : ink.event;
    // the text below it stays readable
    const line = { colour, width: 1, alpha: 0.75, dashes: tone === "alarm" ? [] : [4, 3] };
    paintRule(pen, [Math.round(at) + 0.5, top], [Math.round(at) + 0.5, bottom], line);
    const last = labels.at(-1);
    if (last && at < last.right) {
      if (!say) labels[labels.length - 1] = { ...last, ...about(last.at, `${last.event.seq}–${event.seq}`) };
      continue;
    }
    const next = events.slice(i + 1).find(({ tick }) => x(tick) > at + NEAR);
    const free: [number, number] = [last?.right ?? left, next ? x(next.tick) - 6 : right];
    const placed = say ? beside(at, say(event), free) : about(at, String(event.seq));
    if (placed) labels.push({ ...placed, colour, event, at });
  }
  for (const { text, left, colour } of labels) {
    pen.fillStyle = colour;
    pen.fillText(text, left, top - fontSize / 2 - 5);
  }

  function beside(at: number, text: string, [from, to]: [number, number]) {
    const long = width(text);
    const after = { left: at - 1, right: at + long + 6, text };
    if (at + long <= to) return after;
    if (at - long - 4 >= from) return { left: at - long - 4, right: at + 4, text };
    return at + long <= right ? after : undefined;
  }

  function about(at: number, text: string) {
    const half = width(text) / 2;
    return { left: at - half, right: at + half + 8, text };
  }
}

/** The events in words under a plot; where the list ends. */
export function listEvents(
  pen: Pen,
  events: readonly LogEntry[],
  { dtMs, origin = 0 }: EventAxis,
  left: number,
  top: number,
  width: number,
): number {
  if (events.length === 0) return top;
  const shown = events.slice(0, MOST).map((e) => ({
    number: String(e.seq),
    words: `at ${formatMoment((e.tick - origin) * dtMs)}: ${e.text}`,
  }));
  if (events.length > MOST) shown.push({ number: "", words: `and ${events.length - MOST} more` });
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  pen.fillStyle = INK.text;
  shown.forEach(({ number, words }, i) => {
    const y = top + 8 + LINE * (i + 0.5);
    pen.font = fontFor(13, 1, 600);
    const indent = Math.max(24, pen.measureText(number).width + 8);
    pen.fillText(number, left, y);
    pen.font = fontFor(13, 1, 400);
    pen.fillText(words, left + indent, y, width - indent);
  });
  return top + 8 + LINE * shown.length;
}
