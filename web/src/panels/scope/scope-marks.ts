import uPlot from "uplot";
import type { LogEntry } from "../../api/types";
import { fontFor } from "../../ui/canvas-font";
import { CANVAS, type Scheme } from "../../ui/palette";
import { eventTone } from "../events/event-tone";
import type { FaultSpan } from "../faults/fault-spans";

export interface Marks {
  events: LogEntry[];
  faults: FaultSpan[];
}

/** Draw events as numbered lines and faults as a band along the top, over the traces of a scope. */
export function drawMarks(
  u: uPlot,
  marks: Marks,
  span: { start: number; end: number },
  scheme: Scheme,
  fontSize: number,
): void {
  const { ctx, bbox } = u;
  const ratio = uPlot.pxRatio;
  const colours = CANVAS[scheme];
  const perTick = bbox.width / (span.end - span.start);
  const x = (tick: number) => bbox.left + (tick - span.start) * perTick;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top - (fontSize + 8) * ratio, bbox.width, bbox.height + (fontSize + 8) * ratio);
  ctx.clip();
  for (const fault of marks.faults) {
    if (fault.start > span.end || (fault.end ?? span.end) < span.start) continue;
    const from = Math.max(bbox.left, x(fault.start));
    const to = Math.min(bbox.left + bbox.width, x(fault.end ?? span.end));
    ctx.fillStyle = colours.alarm;
    ctx.fillRect(from, bbox.top - 3 * ratio, to - from, 3 * ratio);
  }
  ctx.font = fontFor(fontSize - 1, ratio, 600);
  ctx.textBaseline = "middle";
  let taken = Number.NEGATIVE_INFINITY;
  for (const event of marks.events) {
    if (event.tick < span.start || event.tick > span.end) continue;
    const tone = eventTone(event);
    if (tone === "quiet") continue;
    const at = Math.round(x(event.tick)) + 0.5;
    ctx.strokeStyle = tone === "alarm" ? colours.alarm : tone === "found" ? colours.accent : colours.event;
    ctx.lineWidth = ratio;
    ctx.setLineDash(tone === "alarm" ? [] : [4 * ratio, 3 * ratio]);
    ctx.beginPath();
    ctx.moveTo(at, bbox.top);
    ctx.lineTo(at, bbox.top + bbox.height);
    ctx.stroke();
    const label = String(event.seq);
    if (at < taken) continue;
    ctx.fillStyle = ctx.strokeStyle;
    ctx.fillText(label, at - ctx.measureText(label).width / 2, bbox.top - (fontSize / 2 + 5) * ratio);
    taken = at + ctx.measureText(label).width + 4 * ratio;
  }
  ctx.restore();
}
