import { formatNumber } from "../../ui/format";
import { CANVAS, DASHES, TRACE_COLOURS } from "../../ui/palette";
import { linearTicks } from "../../ui/ticks";
import { timeLabels, timeSplits, timeUnit } from "../../ui/time-axis";
import type { UnitScale } from "../../ui/unit-scale";
import { eventTone } from "../events/event-tone";
import type { ScopePicture } from "./scope-picture";

export const SVG_WIDTH = 960;
const HEIGHT = 460;
const LEFT = 76;
const AXIS = 70;
const LINE = 17;
const TOP = 14;
const MOST_EVENTS = 12;
const INK = CANVAS.light;

const safe = (text: string) =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");
const words = (name: string) => name.replaceAll(/[._]/g, " ");

/** A trace's colour on white, whatever it is on the screen. */
const onWhite = (colour: string) =>
  TRACE_COLOURS.light[TRACE_COLOURS.dark.indexOf(colour)] ?? (TRACE_COLOURS.light.includes(colour) ? colour : INK.text);

/** What an axis shows: the quantities on it, and their unit. */
export function axisTitle(names: readonly string[], scale: UnitScale): string {
  const quantities = [...new Set(names.map((name) => words(name.split(".").slice(1).join(" ") || name)))];
  const said = quantities.length > 3 ? `${quantities.slice(0, 3).join(", ")}, …` : quantities.join(", ");
  return scale.unit ? `${said}, ${scale.unit}` : said;
}

/** A scope as SVG on white: titled axes, legend, numbered events with their words, faults as a band. */
export function scopeSvg(picture: ScopePicture, title: string): string {
  const { traces, envelopes, times, units, scales, ranges, span, origin, dtMs, marks } = picture;
  const shown = traces.map((trace, i) => ({ trace, i })).filter(({ trace }) => units.includes(trace.unit));
  const events = marks.events.filter((e) => e.tick >= span.start && e.tick <= span.end && eventTone(e) !== "quiet");
  const legendRows = Math.ceil(shown.length / 3);
  const top = TOP + LINE + legendRows * LINE + 20;
  const right = 16 + (units.length - 1) * AXIS;
  const width = SVG_WIDTH - LEFT - right;
  const bottom = top + HEIGHT - 130;
  const height = bottom - top;
  const listed = events.slice(0, MOST_EVENTS);
  const total =
    bottom + 50 + (listed.length ? (listed.length + (events.length > listed.length ? 1 : 0)) * LINE + 8 : 0);
  const start = (span.start - origin) * dtMs;
  const length = (span.end - span.start) * dtMs;
  const x = (ms: number) => LEFT + ((ms - start) / length) * width;
  const y = (value: number, axis: number) =>
    bottom - ((value - ranges[axis].min) / (ranges[axis].max - ranges[axis].min)) * height;
  const out: string[] = [];

  out.push(`<text x="${LEFT}" y="${TOP + 4}" font-size="15" font-weight="600">${safe(title)}</text>`);
  shown.forEach(({ trace }, n) => {
    const at = LEFT + (n % 3) * (width / 3);
    const down = TOP + LINE * (1 + Math.floor(n / 3)) + 6;
    out.push(line(`M${at} ${down}h28`, onWhite(trace.colour), 2.2, trace.dash));
    out.push(`<text x="${at + 34}" y="${down + 4}">${safe(words(trace.name))}</text>`);
  });

  const splits = timeSplits(start, start + length, 8);
  timeLabels(splits, length).forEach((label, i) => {
    const at = x(splits[i]).toFixed(1);
    out.push(line(`M${at} ${top}V${bottom}`, INK.grid, 1));
    out.push(`<text x="${at}" y="${bottom + 17}" text-anchor="middle">${label}</text>`);
  });
  const from = picture.isTriggered ? "time from the trigger" : "time of the device";
  out.push(
    `<text x="${LEFT + width / 2}" y="${bottom + 37}" text-anchor="middle" font-weight="600">${from}, ${timeUnit(length).unit}</text>`,
  );
  units.forEach((unit, axis) => {
    const edge = axis === 0 ? LEFT : LEFT + width + (axis - 1) * AXIS;
    const step = linearTicks(ranges[axis].min, ranges[axis].max, 8);
    const decimals = decimalsOf(step, scales[axis].factor);
    for (const value of step) {
      const down = y(value, axis).toFixed(1);
      if (axis === 0) out.push(line(`M${LEFT} ${down}h${width}`, INK.grid, 1));
      const label = formatNumber(value * scales[axis].factor, decimals);
      out.push(
        axis === 0
          ? `<text x="${edge - 7}" y="${Number(down) + 4}" text-anchor="end">${label}</text>`
          : `<text x="${edge + 7}" y="${Number(down) + 4}">${label}</text>`,
      );
    }
    const names = traces.filter((t) => t.unit === unit).map((t) => t.name);
    const across = axis === 0 ? 18 : edge + AXIS - 12;
    out.push(
      `<text transform="translate(${across} ${(top + bottom) / 2}) rotate(-90)" text-anchor="middle" font-weight="600">${safe(axisTitle(names, scales[axis]))}</text>`,
    );
  });

  for (const fault of marks.faults) {
    if (fault.start > span.end || (fault.end ?? span.end) < span.start) continue;
    const a = x((Math.max(fault.start, span.start) - origin) * dtMs);
    const b = x((Math.min(fault.end ?? span.end, span.end) - origin) * dtMs);
    out.push(
      `<rect x="${a.toFixed(1)}" y="${top - 4}" width="${(b - a).toFixed(1)}" height="4" fill="${INK.alarm}"><title>${safe(words(fault.name))}</title></rect>`,
    );
  }
  for (const event of events) {
    const tone = eventTone(event);
    const colour = tone === "alarm" ? INK.alarm : tone === "found" ? INK.accent : INK.event;
    const at = x((event.tick - origin) * dtMs).toFixed(1);
    out.push(line(`M${at} ${top}V${bottom}`, colour, 1, tone === "alarm" ? 0 : 2));
    out.push(`<text x="${at}" y="${top - 7}" text-anchor="middle" fill="${colour}">${event.seq}</text>`);
  }
  out.push(`<clipPath id="field"><rect x="${LEFT}" y="${top}" width="${width}" height="${height}"/></clipPath>`);
  out.push(`<g clip-path="url(#field)">`);
  for (const { trace, i } of shown) {
    const envelope = envelopes[i];
    if (!envelope) continue;
    const axis = units.indexOf(trace.unit);
    const bars: string[] = [];
    const path: string[] = [];
    for (let c = 0; c < times.length; c += 1) {
      const low = envelope.low[c];
      const high = envelope.high[c];
      if (Number.isNaN(low)) continue;
      const at = x(times[c]).toFixed(1);
      const a = y(low, axis);
      const b = y(high, axis);
      if (a - b > 1) bars.push(`M${at} ${a.toFixed(1)}V${b.toFixed(1)}`);
      path.push(`${path.length ? "L" : "M"}${at} ${((a + b) / 2).toFixed(1)}`);
    }
    if (bars.length) out.push(line(bars.join(""), onWhite(trace.colour), 1.2));
    out.push(line(path.join(""), onWhite(trace.colour), 1.8, trace.dash));
  }
  out.push("</g>", line(`M${LEFT} ${top}V${bottom}H${LEFT + width}`, INK.axis, 1));
  listed.forEach((event, n) => {
    const when = formatNumber((event.tick - origin) * dtMs, 3);
    out.push(
      `<text x="${LEFT}" y="${bottom + 60 + n * LINE}"><tspan font-weight="600">${event.seq}</tspan> at ${when} ms: ${safe(event.text)}</text>`,
    );
  });
  if (events.length > listed.length)
    out.push(
      `<text x="${LEFT}" y="${bottom + 60 + listed.length * LINE}">and ${events.length - listed.length} more</text>`,
    );
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${SVG_WIDTH}" height="${total}" viewBox="0 0 ${SVG_WIDTH} ${total}" ` +
    `font-family="IBM Plex Sans, system-ui, sans-serif" font-size="12.5" fill="${INK.text}">` +
    `<title>${safe(title)}</title><rect width="100%" height="100%" fill="#ffffff"/>${out.join("\n")}</svg>\n`
  );
}

function line(path: string, colour: string, width: number, dash = 0): string {
  const dashes = DASHES[dash].length ? ` stroke-dasharray="${DASHES[dash].join(" ")}"` : "";
  return `<path d="${path}" fill="none" stroke="${colour}" stroke-width="${width}" stroke-linejoin="round"${dashes}/>`;
}

function decimalsOf(steps: readonly number[], factor: number): number {
  const step = steps.length > 1 ? Math.abs(steps[1] - steps[0]) * factor : 1;
  return Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-6)));
}
