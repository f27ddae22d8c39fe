// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import { placeOn } from "../../picture/axes";
import { pictureSvg } from "../../picture/picture";
import { tickRoom } from "../../picture/ticked-range";
import { RecordingPen } from "../../testing/recording-pen";
import { TRACE_COLOURS } from "../../ui/palette";
import { unitScale } from "../../ui/unit-scale";
import { nextRange } from "./axis-range";
import { axisTitle, paintScope, type ScopeShown, scopePicture } from "./paint-scope";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const flat = (values: number[]) => ({ low: Float32Array.from(values), high: Float32Array.from(values) });
const MICRO = { factor: 1, unit: "µm", decimals: 3, exponent: "" };

const PICTURE: ScopeShown = {
  traces: [
    { name: "plant.displacement", unit: "um", slot: 1, colour: TRACE_COLOURS.dark[1], dash: 0 },
    { name: "drive.voltage", unit: "V", slot: 5, colour: TRACE_COLOURS.dark[5], dash: 4 },
  ],
  envelopes: [flat([-1, 0, 1]), { low: Float32Array.of(0, -5, 0), high: Float32Array.of(0, 5, 0) }],
  bands: [1],
  times: Float64Array.of(1, 1.5, 2),
  units: ["um", "V"],
  scales: [MICRO, { factor: 1, unit: "V", decimals: 2, exponent: "" }],
  ranges: [
    { min: -1, max: 1, step: 0.5 },
    { min: -5, max: 5, step: 5 },
  ],
  span: { start: 100, end: 200 },
  origin: 0,
  isTriggered: false,
  isLog: false,
  dtMs: 0.01,
  marks: {
    events: [
      { seq: 7, tick: 150, time_ms: 1.5, kind: "inject", text: "mass < 5 % & more", actor: "page" },
      { seq: 8, tick: 900, time_ms: 9, kind: "inject", text: "out of sight", actor: "page" },
      { seq: 9, tick: 160, time_ms: 1.6, kind: "pause", text: "quiet", actor: "page" },
    ] as unknown as ScopeShown["marks"]["events"],
    faults: [{ name: "added_mass", severity: 0.05, start: 150, end: undefined }],
  },
  printed: [],
};

const drawn = (title: string) =>
  new DOMParser().parseFromString(pictureSvg(scopePicture(PICTURE, title, "scope")), "image/svg+xml");
/** Left, top, width and height of the field of the traces. */
const fieldOf = (document: Document) =>
  (/^M(\S+) (\S+)h(\S+)v(\S+)h/.exec(document.querySelector("clipPath path")?.getAttribute("d") ?? "") ?? [])
    .slice(1)
    .map(Number);

it("is well-formed, with a title for each axis and a name for each trace", () => {
  const document = drawn("First look & more");
  expect(document.querySelector("parsererror")).toBeNull();
  const texts = [...document.querySelectorAll("text")].map((node) => node.textContent);
  expect(texts).toContain("First look & more");
  expect(texts).toContain("displacement, µm");
  expect(texts).toContain("voltage, V");
  expect(texts).toContain("time of the device, ms");
  expect(texts).toContain("plant displacement");
  expect(texts).toContain("drive voltage, envelope");
});

it("marks and tells the events in sight that speak, and bands the faults", () => {
  const document = drawn("t");
  const texts = [...document.querySelectorAll("text")].map((node) => node.textContent ?? "");
  expect(texts.filter((text) => text === "7")).toHaveLength(2); // at its line and in the list
  expect(texts).toContain("at 1.500\u00a0ms: mass < 5 % & more");
  expect(texts.some((text) => /out of sight|quiet/.test(text))).toBe(false);
  const band = document.querySelector("rect[height='4']");
  // from the middle of the field to its right edge
  expect(Number(band?.getAttribute("width"))).toBeCloseTo(fieldOf(document)[2] / 2, 0);
});

it("draws every value where its axis says, in the colours of white paper", () => {
  const document = drawn("t");
  const [, top, , height] = fieldOf(document);
  const bottom = top + height;
  const [motion, spike] = document.querySelectorAll("g[clip-path] path");
  expect(motion.getAttribute("stroke")).toBe(TRACE_COLOURS.light[1]);
  const heights = [...(motion.getAttribute("d") ?? "").matchAll(/[ML]\S+ (\S+?)(?=[ML]|$)/g)].map((m) => Number(m[1]));
  expect(heights).toEqual([bottom, (top + bottom) / 2, top]);
  // the column of the spike is a bar from floor to ceiling
  expect(spike.getAttribute("d")).toMatch(new RegExp(`^M(\\S+) ${bottom}L\\1 ${top}$`));
});

it("says no more than three quantities on one axis", () => {
  expect(axisTitle(["a.p", "b.q", "c.r", "d.s"], MICRO)).toBe("p, q, r, …, µm");
  expect(axisTitle(["a.p.b", "a.p.c", "a.p.d", "a.p.e"], MICRO)).toBe("p, µm");
  expect(axisTitle(["plant.displacement", "model.displacement"], MICRO)).toBe("displacement, µm");
});

const MAGNITUDES = [1e-9, 3.7e-4, 0.24, 1, 6.6, 99.9, 12345];
/** Middles of a range, in its widths: about zero, above it, far below it. */
const MIDDLES = [0, 0.3, 1.2, -40, 700];

it.each(MAGNITUDES)("has a number above the highest and below the lowest point of traces of about %s", (size) => {
  for (const middle of MIDDLES)
    for (const [tall, fontSize] of [
      [60, 12],
      [131, 15],
      [210, 12],
      [700, 20],
    ] as const) {
      const [low, high] = [size * (middle - 0.5), size * (middle + 0.5)];
      const range = nextRange(undefined, low, high, 0, tickRoom(tall, fontSize));
      const pen = new RecordingPen();
      const field = { left: 60, right: 400, top: 20, bottom: 20 + tall };
      const scales = [unitScale("um", Math.max(Math.abs(range.min), Math.abs(range.max)))];
      const shown = { ...PICTURE, units: ["um"], scales, ranges: [range], traces: PICTURE.traces.slice(0, 1) };
      paintScope(pen, field, shown, { scheme: "dark", fontSize }, { ink: () => undefined });
      const y = placeOn({ range: [range.min, range.max] }, field.bottom, field.top);
      const numbers = pen.texts.filter(({ align, text }) => align === "right" && /\d/.test(text));
      const heights = numbers.map(({ points }) => points[0][1]);
      const told = `${low} to ${high} on ${tall} px`;
      expect(Math.min(...heights), told).toBeLessThan(y(high) - 1);
      expect(Math.max(...heights), told).toBeGreaterThan(y(low) + 1);
      expect(Math.min(...heights), told).toBeGreaterThanOrEqual(field.top - 0.01);
      expect(Math.max(...heights), told).toBeLessThanOrEqual(field.bottom + 0.01);
      expect(new Set(numbers.map(({ text }) => text)).size, told).toBe(numbers.length);
      expect(y(low) - y(high), told).toBeGreaterThan(0.3 * tall);
    }
});
