// @vitest-environment jsdom
import { expect, it } from "vitest";
import { TRACE_COLOURS } from "../../ui/palette";
import type { ScopePicture } from "./scope-picture";
import { axisTitle, scopeSvg } from "./scope-svg";

const flat = (values: number[]) => ({ low: Float32Array.from(values), high: Float32Array.from(values) });
const MICRO = { factor: 1, unit: "µm", decimals: 3 };

const PICTURE: ScopePicture = {
  traces: [
    { name: "plant.displacement", unit: "um", colour: TRACE_COLOURS.dark[1], dash: 0 },
    { name: "drive.voltage", unit: "V", colour: TRACE_COLOURS.dark[5], dash: 4 },
  ],
  envelopes: [flat([-1, 0, 1]), { low: Float32Array.of(0, -5, 0), high: Float32Array.of(0, 5, 0) }],
  times: Float64Array.of(1, 1.5, 2),
  units: ["um", "V"],
  scales: [MICRO, { factor: 1, unit: "V", decimals: 2 }],
  ranges: [
    { min: -1, max: 1 },
    { min: -5, max: 5 },
  ],
  span: { start: 100, end: 200 },
  origin: 0,
  isTriggered: false,
  dtMs: 0.01,
  marks: {
    events: [
      { seq: 7, tick: 150, time_ms: 1.5, kind: "inject", text: "mass < 5 % & more", actor: "page" },
      { seq: 8, tick: 900, time_ms: 9, kind: "inject", text: "out of sight", actor: "page" },
      { seq: 9, tick: 160, time_ms: 1.6, kind: "pause", text: "quiet", actor: "page" },
    ] as unknown as ScopePicture["marks"]["events"],
    faults: [{ name: "added_mass", severity: 0.05, start: 150, end: undefined }],
  },
};

const parse = (svg: string) => new DOMParser().parseFromString(svg, "image/svg+xml");

it("is well-formed, with a title for each axis and a name for each trace", () => {
  const document = parse(scopeSvg(PICTURE, "First look & more"));
  expect(document.querySelector("parsererror")).toBeNull();
  const texts = [...document.querySelectorAll("text")].map((node) => node.textContent);
  expect(texts).toContain("First look & more");
  expect(texts).toContain("displacement, µm");
  expect(texts).toContain("voltage, V");
  expect(texts).toContain("time of the device, ms");
  expect(texts).toContain("plant displacement");
});

it("marks and tells the events in sight that speak, and bands the faults", () => {
  const document = parse(scopeSvg(PICTURE, "t"));
  const texts = [...document.querySelectorAll("text")].map((node) => node.textContent ?? "");
  expect(texts.filter((text) => text === "7")).toHaveLength(1);
  expect(texts).toContain("7 at 1.500 ms: mass < 5 % & more");
  expect(texts.some((text) => /out of sight|quiet/.test(text))).toBe(false);
  const band = document.querySelector("rect[height='4']");
  // from the middle of the field to its right edge
  const field = document.querySelector("clipPath rect");
  expect(Number(band?.getAttribute("width"))).toBeCloseTo(Number(field?.getAttribute("width")) / 2, 0);
});

it("draws every value where its axis says, in the colours of white paper", () => {
  const document = parse(scopeSvg(PICTURE, "t"));
  const field = document.querySelector("clipPath rect");
  const top = Number(field?.getAttribute("y"));
  const bottom = top + Number(field?.getAttribute("height"));
  const paths = [...document.querySelectorAll("g path")];
  const [motion] = paths;
  expect(motion.getAttribute("stroke")).toBe(TRACE_COLOURS.light[1]);
  const heights = [...(motion.getAttribute("d") ?? "").matchAll(/[ML]\S+ (\S+?)(?=[ML]|$)/g)].map((m) => Number(m[1]));
  expect(heights).toEqual([bottom, (top + bottom) / 2, top]);
  // the column of the spike is a bar from floor to ceiling
  expect(paths[1].getAttribute("d")).toMatch(new RegExp(`${bottom.toFixed(1)}V${top.toFixed(1)}$`));
});

it("says no more than three quantities on one axis", () => {
  expect(axisTitle(["a.p", "b.q", "c.r", "d.s"], MICRO)).toBe("p, q, r, …, µm");
  expect(axisTitle(["plant.displacement", "model.displacement"], MICRO)).toBe("displacement, µm");
});
