import type { RecordDetail } from "../api/types";
import { linearAxis, type Plot, paintAxes, timeAxis } from "../picture/axes";
import type { Box, Look, Pen } from "../picture/pen";
import { within } from "../picture/traces";
import { CANVAS, TRACE_COLOURS } from "../ui/palette";

export interface RecordShown {
  record: RecordDetail;
  range: readonly [number, number];
  healthy: readonly [number, number];
}

/** The room of the numbers of both lanes, px for each px of the letters. */
const GUTTER = 4.2;

/** The voltage over the displacement, each as its extremes, with the healthy stretch behind them; returns the lower plot. */
export function paintRecord(pen: Pen, box: Box, { record, range, healthy }: RecordShown, look: Look): Plot {
  const lanes = [
    { title: "voltage, V", low: record.plot.drive_low, high: record.plot.drive_high, whole: record.drive_v, slot: 2 },
    {
      title: "displacement, µm",
      low: record.plot.displacement_low,
      high: record.plot.displacement_high,
      whole: record.displacement_um,
      slot: 1,
    },
  ];
  const height = box.height / lanes.length;
  const silent = { say: () => [], unit: undefined };
  const time = timeAxis({ start: range[0], end: range[1] }, 1 / record.rate_khz);
  let last: Plot | undefined;
  lanes.forEach(({ title, low, high, whole, slot }, i) => {
    pen.save();
    pen.translate(0, i * height);
    const up = linearAxis(roomAround(whole), title);
    const across = i < lanes.length - 1 ? { ...time, ...silent } : time; // the lowest lane has the numbers
    const plot = paintAxes(pen, { width: box.width, height }, across, up, look, { gutter: GUTTER * look.fontSize });
    within(pen, plot.field, () => {
      pen.globalAlpha = 0.16;
      pen.fillStyle = CANVAS[look.scheme].accent;
      const [from, to] = healthy.map(plot.x);
      pen.fillRect(from, plot.field.top, to - from, plot.field.bottom - plot.field.top);
      pen.globalAlpha = 1;
      paintExtremes(pen, plot, record.plot.sample, low, high, TRACE_COLOURS[look.scheme][slot]);
    });
    pen.restore();
    last = plot;
  });
  return last as Plot;
}

/** A column from minimum to maximum of each stretch, joined to the next; nothing where all samples are lost. */
function paintExtremes(
  pen: Pen,
  plot: Plot,
  samples: readonly number[],
  low: readonly (number | null)[],
  high: readonly (number | null)[],
  colour: string,
): void {
  pen.strokeStyle = colour;
  pen.lineWidth = 1.2;
  pen.lineJoin = "round";
  pen.beginPath();
  let isBegun = false;
  samples.forEach((sample, i) => {
    const [least, most] = [low[i], high[i]];
    if (least === null || most === null) {
      isBegun = false;
      return;
    }
    const x = plot.x(sample);
    if (isBegun) pen.lineTo(x, plot.y(most));
    else pen.moveTo(x, plot.y(most));
    if (least !== most) pen.lineTo(x, plot.y(least));
    isBegun = true;
  });
  pen.stroke();
}

function roomAround([low, high]: readonly number[]): [number, number] {
  const room = (high - low || 1) * 0.06;
  return [low - room, high + room];
}
