import type { EventAxis } from "../../picture/event-marks";
import type { Box, Field, Pen } from "../../picture/pen";
import type { Picture } from "../../picture/picture";
import { fontFor } from "../../ui/canvas-font";
import { labelsOn } from "../../ui/format";
import { CANVAS, DASHES, onWhite } from "../../ui/palette";
import { linearTicks } from "../../ui/ticks";
import { timeLabels, timeSplits } from "../../ui/time-axis";
import type { UnitScale } from "../../ui/unit-scale";
import type { ScopePicture } from "./scope-picture";

/** Room for an upright axis with its title, and for the numbers under the field, px. */
const AXIS = 70;
const FEET = 22;
const INK = CANVAS.light;

const words = (name: string) => name.replaceAll(/[._]/g, " ");

/** What an axis shows: the quantities on it, and their unit. */
export function axisTitle(names: readonly string[], scale: UnitScale): string {
  const quantities = [...new Set(names.map((name) => words(name.split(".").slice(1).join(" ") || name)))];
  const said = quantities.length > 3 ? `${quantities.slice(0, 3).join(", ")}, …` : quantities.join(", ");
  return scale.unit ? `${said}, ${scale.unit}` : said;
}

/** A scope as a picture: an upright axis for each unit, time below. */
export function printScope(shown: ScopePicture, title: string, stem: string): Picture {
  const { traces, bands, units, span, dtMs, origin, isTriggered, marks } = shown;
  const time: EventAxis = { span, dtMs, origin, isTriggered, marks, field: (box) => fieldOf(box, units.length) };
  const legend = traces
    .filter((trace) => units.includes(trace.unit))
    .map(({ name, colour, dash }) => ({
      name: bands.includes(traces.findIndex((trace) => trace.name === name)) ? `${words(name)}, envelope` : words(name),
      colour: onWhite(colour),
      dashes: DASHES[dash],
    }));
  return { stem, title, legend, height: 350, time, paint: (pen, box) => paintScope(pen, shown, time.field(box)) };
}

const fieldOf = ({ width, height }: Box, axes: number): Field => ({
  left: AXIS - 10,
  right: width - (axes - 1) * AXIS,
  top: 0,
  bottom: height - FEET,
});

function paintScope(pen: Pen, shown: ScopePicture, field: Field): void {
  const { traces, envelopes, times, units, ranges, span, origin, dtMs } = shown;
  const { left, right, top, bottom } = field;
  const start = (span.start - origin) * dtMs;
  const length = (span.end - span.start) * dtMs;
  const x = (ms: number) => left + ((ms - start) / length) * (right - left);
  const y = (value: number, axis: number) =>
    bottom - ((value - ranges[axis].min) / (ranges[axis].max - ranges[axis].min)) * (bottom - top);

  pen.font = fontFor(13, 1, 400);
  pen.textBaseline = "middle";
  pen.lineWidth = 1;
  const splits = timeSplits(start, start + length, 8);
  timeLabels(splits, length).forEach((label, i) => {
    stroke(pen, INK.grid, [x(splits[i]), top], [x(splits[i]), bottom]);
    pen.textAlign = "center";
    pen.fillStyle = INK.text;
    pen.fillText(label, x(splits[i]), bottom + 13);
  });
  for (const axis of units.keys()) paintAxis(pen, shown, field, axis, (value) => y(value, axis));

  pen.save();
  pen.beginPath();
  pen.rect(left, top, right - left, bottom - top);
  pen.clip();
  traces.forEach(({ unit, colour, dash }, i) => {
    const axis = units.indexOf(unit);
    const envelope = envelopes[i];
    if (axis < 0 || !envelope) return;
    const { low, high } = envelope;
    pen.strokeStyle = onWhite(colour);
    pen.lineJoin = "round";
    pen.lineWidth = 1.2;
    pen.beginPath();
    low.forEach((value, c) => {
      if (y(value, axis) - y(high[c], axis) <= 1) return;
      pen.moveTo(x(times[c]), y(value, axis));
      pen.lineTo(x(times[c]), y(high[c], axis));
    });
    pen.stroke();
    pen.lineWidth = 1.8;
    pen.setLineDash([...DASHES[dash]]);
    pen.beginPath();
    low.forEach((value, c) => {
      pen.lineTo(x(times[c]), (y(value, axis) + y(high[c], axis)) / 2);
    });
    pen.stroke();
    pen.setLineDash([]);
  });
  pen.restore();
  stroke(pen, INK.axis, [left, top], [left, bottom], [right, bottom]);
}

/** An upright axis with its numbers and its title: the first on the left, with the grid, the others on the right. */
function paintAxis(
  pen: Pen,
  { traces, units, ranges, scales }: ScopePicture,
  { left, right, top, bottom }: Field,
  axis: number,
  y: (value: number) => number,
): void {
  const onLeft = axis === 0;
  const edge = onLeft ? left : right + (axis - 1) * AXIS;
  const ticks = linearTicks(ranges[axis].min, ranges[axis].max, 8);
  const labels = labelsOn(scales[axis], ticks);
  pen.fillStyle = INK.text;
  pen.textAlign = onLeft ? "right" : "left";
  for (const [i, value] of ticks.entries()) {
    if (onLeft) stroke(pen, INK.grid, [left, y(value)], [right, y(value)]);
    pen.fillText(labels[i], edge + (onLeft ? -7 : 7), y(value));
  }
  pen.save();
  pen.translate(onLeft ? 6 : edge + AXIS - 12, (top + bottom) / 2);
  pen.rotate(-Math.PI / 2);
  pen.textAlign = "center";
  pen.font = fontFor(13, 1, 600);
  const names = traces.filter((t) => t.unit === units[axis]).map((t) => t.name);
  pen.fillText(axisTitle(names, scales[axis]), 0, 0, bottom - top);
  pen.restore();
}

function stroke(pen: Pen, colour: string, ...points: [number, number][]): void {
  pen.strokeStyle = colour;
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
  pen.stroke();
}
