import type { PrintedMark } from "../../api/types";
import type { Driven } from "../../bench/driven";
import type { Marks } from "../../bench/marks";
import { type Axis, paintColumns, paintFrame, paintRows, placeOn, tickedAxis, timeAxis } from "../../picture/axes";
import type { EventAxis } from "../../picture/event-marks";
import type { Box, Field, Look, Pen } from "../../picture/pen";
import type { Picture } from "../../picture/picture";
import { paintPrinted } from "../../picture/printed-marks";
import { type TickedRange, ticksOf } from "../../picture/ticked-range";
import { strokeEnvelope, within } from "../../picture/traces";
import { formatSi } from "../../ui/format";
import { CANVAS, DASHES, faded, fontFor, type Scheme, TRACE_COLOURS } from "../../ui/palette";
import type { UnitScale } from "../../ui/unit-scale";
import type { Envelope } from "./envelope-path";

/** A signal on a scope. */
export interface PlotTrace {
  name: string;
  unit: string;
  /** In `TRACE_COLOURS`; its colour on this screen. */
  slot: number;
  colour: string;
  /** In `DASHES`. */
  dash: number;
  /** The name of its bench, for a trace behind the traces of the page; `BEFORE` for a ghost. */
  behind?: string;
  /** When its controller drove, where it is shown for that time alone. */
  drives?: readonly Driven[];
}

/** Names the traces as they were before the last change. */
export const BEFORE = "before";

/** Before the unit of a difference, which has an axis of its own. */
export const DIFFERENCE = "Δ ";

/** The order in which traces are inked: traces of other benches come first. */
export const inkOrder = (traces: readonly PlotTrace[], inked: readonly number[]): number[] => [
  ...inked.filter((i) => traces[i].behind !== undefined),
  ...inked.filter((i) => traces[i].behind === undefined),
];

/** Everything a scope shows at a moment. */
export interface ScopeShown {
  traces: PlotTrace[];
  envelopes: Envelope[];
  /** Traces that are seen as bands and not as signals. */
  bands: readonly number[];
  /** Of each column, in ms from the origin of the time axis. */
  times: Float64Array;
  /** Units with an axis. */
  units: string[];
  scales: UnitScale[];
  /** Of each unit's axis, in the unit of the signals. */
  ranges: TickedRange[];
  /** Ticks shown. */
  span: { start: number; end: number };
  /** Tick that the time axis calls zero. */
  origin: number;
  isTriggered: boolean;
  /** Envelopes and ranges are decimal logarithms of magnitudes. */
  isLog: boolean;
  dtMs: number;
  marks: Marks;
  /** Printed marks, drawn under the traces. */
  printed: readonly PrintedMark[];
}

/** Room for an upright axis in sizes of its letters, with a unit above it, and with a title at its side. */
export const AXIS = 4;
const TITLED_AXIS = 5.4;
const FEET_PX = 22;

interface ScopeOptions {
  /** Ink traces: the screen has many a second, a file is looked at closely. */
  ink(traces: readonly number[]): void;
  /** With titles beside the axes in place of units above them. */
  isTitled?: boolean;
}

/** A scope: device time below, an upright axis for each unit, and the traces within. */
export function paintScope(pen: Pen, field: Field, shown: ScopeShown, look: Look, options: ScopeOptions): void {
  const { traces, units, scales, ranges, span, dtMs, origin } = shown;
  const { left, right, top, bottom } = field;
  const { fontSize } = look;
  paintColumns(pen, field, timeAxis(span, dtMs, origin), look);
  units.forEach((unit, i) => {
    const onLeft = i === 0;
    const edge = right + (i - 1) * (options.isTitled ? TITLED_AXIS : AXIS) * fontSize;
    const axis = shown.isLog ? magnitudeAxis(ranges[i], unit) : tickedAxis(ranges[i], scales[i]);
    paintRows(pen, field, axis, look, onLeft ? undefined : edge);
    pen.font = fontFor(fontSize, 1, 600);
    if (options.isTitled) {
      pen.fillStyle = CANVAS[look.scheme].text;
      const names = traces.filter((trace) => trace.unit === unit).map(({ name }) => name);
      pen.save();
      const place = onLeft ? left - (TITLED_AXIS - 0.6) * fontSize : edge + (TITLED_AXIS - 0.9) * fontSize;
      pen.translate(place, (top + bottom) / 2);
      pen.rotate(-Math.PI / 2);
      pen.textAlign = "center";
      pen.fillText(axisTitle(names, scales[i]), 0, 0, bottom - top);
      pen.restore();
    } else {
      pen.fillStyle = CANVAS[look.scheme].muted;
      pen.textAlign = onLeft ? "right" : "left";
      pen.fillText(shown.isLog ? "log" : scales[i].unit, onLeft ? left - 6 : edge + 6, top - fontSize * 0.85 - 4);
    }
  });
  if (!shown.isLog) paintPrinted(pen, field, shown.printed, printedOn(shown, field, look.scheme), look);
  const inked = traces.flatMap(({ unit }, i) => (units.includes(unit) && shown.envelopes[i] ? [i] : []));
  within(pen, field, () => options.ink(inked));
  paintFrame(pen, field, look);
}

/** Places and colours of printed marks on a scope. */
function printedOn({ traces, units, ranges, span }: ScopeShown, { bottom, top }: Field, scheme: Scheme) {
  const traceOf = (signal: string) => traces.find(({ name, behind }) => name === signal && behind === undefined);
  return {
    span,
    placeOf(signal: string) {
      const range = ranges[units.indexOf(traceOf(signal)?.unit ?? "")];
      return range && placeOn({ range: [range.min, range.max] }, bottom, top);
    },
    colourOf: (signal: string) => TRACE_COLOURS[scheme][traceOf(signal)?.slot ?? 0],
  };
}

/** Within so many decades 2 and 5 have a tick as well. */
const FEW_DECADES = 2;

/** An axis whose values are decimal logarithms of magnitudes. */
function magnitudeAxis(range: TickedRange, unit: string): Axis {
  const own = unit.startsWith(DIFFERENCE) ? unit.slice(DIFFERENCE.length) : unit;
  const { min, max, step } = range;
  const parts = max - min > FEW_DECADES ? [1] : [1, 2, 5];
  const ticks = ticksOf({ min, max, step }).flatMap((tick) => parts.map((part) => tick + Math.log10(part)));
  return {
    range: [min, max],
    ticks: () => ticks.filter((tick) => tick <= max),
    say: (shown) => shown.map((tick) => formatSi(10 ** tick, own, 1)),
  };
}

const words = (name: string) => name.replaceAll(/[._]/g, " ");

/** The title of an axis: the quantities on it, and their unit. */
export function axisTitle(names: readonly string[], scale: UnitScale): string {
  const quantities = [...new Set(names.map((name) => words(name.split(".").slice(1).join(" ") || name)))];
  const alike = new Set(quantities.map((quantity) => quantity.split(" ")[0]));
  if (quantities.length > 3 && alike.size === 1) return titled([...alike][0], scale);
  const said = quantities.length > 3 ? `${quantities.slice(0, 3).join(", ")}, …` : quantities.join(", ");
  return titled(said, scale);
}

const titled = (said: string, { unit }: UnitScale) => (unit ? `${said}, ${unit}` : said);

/** The colour of a trace in a scheme, whichever scheme the screen has. */
function inkOf({ slot, behind }: PlotTrace, scheme: Scheme): string {
  const colour = TRACE_COLOURS[scheme][slot];
  return behind === undefined ? colour : faded(colour, scheme);
}

/** A scope as a picture. */
export function scopePicture(shown: ScopeShown, title: string, stem: string): Picture {
  const { traces, envelopes, bands, units, ranges, times, span, dtMs, origin, isTriggered, marks } = shown;
  const fieldOf = ({ width, height }: Box, fontSize: number): Field => ({
    left: TITLED_AXIS * fontSize,
    right: width - Math.max(4, (units.length - 1) * TITLED_AXIS * fontSize),
    top: 0,
    bottom: height - FEET_PX,
  });
  const time: EventAxis = {
    span,
    dtMs,
    origin,
    isTriggered,
    marks,
    field: (box, { fontSize }) => fieldOf(box, fontSize),
  };
  return {
    stem,
    title,
    legend: traces.flatMap((trace, i) => {
      const said = `${words(trace.name)}${trace.behind === undefined ? "" : ` (${trace.behind})`}`;
      const name = bands.includes(i) ? `${said}, envelope` : said;
      return units.includes(trace.unit) ? [{ name, colour: inkOf(trace, "light"), dashes: DASHES[trace.dash] }] : [];
    }),
    height: 350,
    time,
    paint(pen, box, look) {
      const field = fieldOf(box, look.fontSize);
      const trace = (index: number) => {
        const { unit, dash } = traces[index];
        const { min, max } = ranges[units.indexOf(unit)];
        const start = (span.start - origin) * dtMs;
        const ms = placeOn({ range: [start, start + (span.end - span.start) * dtMs] }, field.left, field.right);
        const y = placeOn({ range: [min, max] }, field.bottom, field.top);
        const stroke = { colour: inkOf(traces[index], look.scheme), width: 1.8, dashes: DASHES[dash] };
        strokeEnvelope(pen, { x: (column) => ms(times[column]), y }, envelopes[index], stroke);
      };
      paintScope(pen, field, shown, look, { ink: (inked) => inkOrder(traces, inked).forEach(trace), isTitled: true });
    },
  };
}
