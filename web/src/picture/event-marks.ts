import type { LogEntry } from "../api/types";
import { eventTone } from "../bench/event-tone";
import { type Marks, marksNow } from "../bench/marks";
import type { PanelFrame } from "../stream/panel-frame";
import { fontFor } from "../ui/canvas-font";
import { formatMoment } from "../ui/format";
import { CANVAS } from "../ui/palette";
import { timeUnit } from "../ui/time-axis";
import { type Box, type Field, type Look, PAPER, type Pen } from "./pen";

/** An axis of device time and what happened along it. */
export interface EventAxis {
  /** Ticks shown. */
  span: { start: number; end: number };
  dtMs: number;
  /** Tick that the axis calls zero. */
  origin?: number;
  isTriggered?: boolean;
  marks: Marks;
  /** Where the axis lies in a plot of a size. */
  field(box: Box): Field;
}

/** The axis of a frame of device time, with what has happened on the bench. */
export const eventAxis = (
  { frame, span }: { frame: PanelFrame; span: { start: number; end: number } },
  fieldOf: (box: Box, look: Look) => Field,
): EventAxis => ({ span, dtMs: frame.dtMs, marks: marksNow(), field: (box) => fieldOf(box, PAPER) });

const INK = CANVAS.light;
const LINE = 18;
const MOST = 12;

export const timeTitle = ({ span, dtMs, isTriggered }: EventAxis) =>
  `${isTriggered ? "time from the trigger" : "time of the device"}, ${timeUnit((span.end - span.start) * dtMs).unit}`;

/** The events in sight that speak. */
export const eventsWithin = ({ marks, span }: EventAxis): LogEntry[] =>
  marks.events.filter((e) => e.tick >= span.start && e.tick <= span.end && eventTone(e) !== "quiet");

/** Events as numbered lines over a plot, faults as bands along its top; numbers without room join into a range. */
export function markEvents(pen: Pen, events: readonly LogEntry[], { span, marks }: EventAxis, field: Field): void {
  const { left, right, top, bottom } = field;
  const x = (tick: number) => left + ((tick - span.start) / (span.end - span.start)) * (right - left);
  pen.fillStyle = INK.alarm;
  for (const fault of marks.faults) {
    if (fault.start > span.end || (fault.end ?? span.end) < span.start) continue;
    const from = x(Math.max(fault.start, span.start));
    pen.fillRect(from, top - 4, x(Math.min(fault.end ?? span.end, span.end)) - from, 4);
  }
  pen.font = fontFor(12, 1, 600);
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  const labels: { at: number; from: number; to: number; colour: string }[] = [];
  for (const event of events) {
    const at = x(event.tick);
    const tone = eventTone(event);
    const colour = tone === "alarm" ? INK.alarm : tone === "found" ? INK.accent : INK.event;
    pen.strokeStyle = colour;
    pen.globalAlpha = 0.75; // what it crosses stays readable
    pen.lineWidth = 1;
    pen.setLineDash(tone === "alarm" ? [] : [4, 3]);
    pen.beginPath();
    pen.moveTo(at, top);
    pen.lineTo(at, bottom);
    pen.stroke();
    const last = labels.at(-1);
    if (last && at - last.at < 8 + pen.measureText(spoken(last)).width) last.to = event.seq;
    else labels.push({ at, from: event.seq, to: event.seq, colour });
  }
  pen.setLineDash([]);
  pen.globalAlpha = 1;
  for (const label of labels) {
    pen.fillStyle = label.colour;
    pen.fillText(spoken(label), label.at, top - 12);
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

const spoken = ({ from, to }: { from: number; to: number }) => (from === to ? String(from) : `${from}–${to}`);
