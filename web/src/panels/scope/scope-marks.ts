import uPlot from "uplot";
import { eventTone } from "../../bench/event-tone";
import { flagWords } from "../../bench/flag-words";
import type { Marks } from "../../bench/marks";
import { fontFor } from "../../ui/canvas-font";
import { CANVAS, type Scheme } from "../../ui/palette";

/** Draw events as lines with flags and faults as a band along the top, over the traces of a scope. */
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
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  const flags = marks.events.filter((e) => e.tick >= span.start && e.tick <= span.end && eventTone(e) !== "quiet");
  let taken = Number.NEGATIVE_INFINITY;
  flags.forEach((event, i) => {
    const tone = eventTone(event);
    const at = Math.round(x(event.tick)) + 0.5;
    ctx.strokeStyle = tone === "alarm" ? colours.alarm : tone === "found" ? colours.accent : colours.event;
    ctx.lineWidth = ratio;
    ctx.setLineDash(tone === "alarm" ? [] : [4 * ratio, 3 * ratio]);
    ctx.beginPath();
    ctx.moveTo(at, bbox.top);
    ctx.lineTo(at, bbox.top + bbox.height);
    ctx.stroke();
    if (at < taken) return;
    // words where they have room before the next flag, otherwise the number of the event
    const next = flags.slice(i + 1).find(({ tick }) => tick > event.tick);
    const room = (next ? x(next.tick) : bbox.left + bbox.width) - at;
    const words = flagWords(event);
    const label = ctx.measureText(words).width < room - 6 * ratio ? words : String(event.seq);
    const width = ctx.measureText(label).width;
    ctx.fillStyle = ctx.strokeStyle;
    ctx.fillText(label, label === words ? at - ratio : at - width / 2, bbox.top - (fontSize / 2 + 5) * ratio);
    taken = at + width + 6 * ratio;
  });
  ctx.restore();
}
