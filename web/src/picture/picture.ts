import { useBench } from "../stream/bench-store";
import { CANVAS, fontFor } from "../ui/palette";
import { type EventAxis, eventsWithin, listEvents, markEvents, timeTitle } from "./event-marks";
import { type LegendEntry, paintLegend } from "./legend";
import { type Box, type Look, PAPER, type Pen } from "./pen";
import { SvgPen } from "./svg-pen";

/** A picture of a panel for a file: its own painter, in light colours, with title, legend and axes. */
export interface Picture {
  /** The file's name, without its ending. */
  stem: string;
  title: string;
  /** Titles of the axes, with units; a painter with several of a kind writes its own. */
  across?: string;
  up?: string;
  legend?: readonly LegendEntry[];
  /** Of the plot, px. */
  height: number;
  paint(pen: Pen, box: Box, look: Look): void;
  /** An axis of time gets its title and the events of its span. */
  time?: EventAxis;
}

export const PICTURE_WIDTH = 960;
const EDGE = 16;
const AXIS = 24;
const NUMBERS = 20;
const INK = CANVAS.light;

/** A picture as SVG on white: title, legend, plot with titled axes, numbered events with their words. */
export function pictureSvg({ title, across, up, legend = [], height, paint, time }: Picture): string {
  const pen = new SvgPen();
  const left = EDGE + (up ? AXIS : 0);
  const width = PICTURE_WIDTH - left - EDGE;
  const events = time ? eventsWithin(time) : [];
  pen.textBaseline = "middle";
  pen.font = fontFor(16, 1, 600);
  pen.fillStyle = INK.text;
  pen.fillText(title, EDGE, 24, PICTURE_WIDTH - 2 * EDGE);
  const top = paintLegend(pen, legend, EDGE, 46, PICTURE_WIDTH - 2 * EDGE) + (time ? NUMBERS : 4);
  let bottom = top + height;

  pen.save();
  pen.translate(left, top);
  paint(pen, { width, height }, PAPER);
  if (time) markEvents(pen, time, time.field({ width, height }, PAPER), PAPER);
  pen.restore();

  pen.font = fontFor(13, 1, 600);
  pen.fillStyle = INK.text;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  const below = across ?? (time && timeTitle(time));
  if (below) {
    const field = time?.field({ width, height }, PAPER) ?? { left: 0, right: width };
    bottom += AXIS;
    pen.fillText(below, left + (field.left + field.right) / 2, bottom - AXIS / 2);
  }
  if (up) {
    pen.save();
    pen.translate(EDGE + 4, top + height / 2);
    pen.rotate(-Math.PI / 2);
    pen.fillText(up, 0, 0, height);
    pen.restore();
  }
  if (time) bottom = listEvents(pen, events, time, EDGE, bottom, PICTURE_WIDTH - 2 * EDGE);
  return pen.svg(PICTURE_WIDTH, bottom + 12, title);
}

/** A name for a file. */
export const fileStem = (name: string) =>
  name
    .toLowerCase()
    .replaceAll(/[^a-z0-9]+/g, "-")
    .replaceAll(/^-|-$/g, "");

/** The title and the file name of a picture of the bench that is connected. */
export function pictureName(what: string): { title: string; stem: string } {
  const bench = useBench.getState().bench;
  const stem = fileStem(`${bench?.scenario_id ?? "bench"}-${what}`);
  return { title: bench ? `${what} · ${bench.title}` : what, stem };
}
