// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import type { PrintedMark } from "../api/types";
import { placeOn } from "./axes";
import { paintPrinted, reachMarks } from "./printed-marks";
import { SvgPen } from "./svg-pen";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const FIELD = { left: 100, right: 500, top: 20, bottom: 220 };
const SPAN = { start: 1000, end: 2000 };
const MARK: PrintedMark = {
  figure: "9.1",
  section: "9",
  words: "at least 2 micron",
  number: "2 micron",
  reading: "",
  kind: "band",
  signal: "plant.displacement",
  unit: "um",
  low: 2,
  high: 3,
  values: [],
  from_tick: 1250,
  until_tick: 1750,
  problem: "",
};

function drawn(...marks: PrintedMark[]): Document {
  const pen = new SvgPen();
  const plot = {
    span: SPAN,
    // 50 px for each unit, 0 at the foot
    placeOf: (signal: string) =>
      signal === "plant.displacement" ? placeOn({ range: [0, 4] }, FIELD.bottom, FIELD.top) : undefined,
    colourOf: () => "#123456",
  };
  paintPrinted(pen, FIELD, marks, plot, { scheme: "light", fontSize: 12 });
  return new DOMParser().parseFromString(pen.svg(600, 300, "t"), "image/svg+xml");
}

const numbers = (element: Element | null, ...names: string[]) =>
  names.map((name) => Number(element?.getAttribute(name)));
const texts = (document: Document) => [...document.querySelectorAll("text")].map((node) => node.textContent);
const ground = (document: Document) => document.querySelector("rect[fill^='#123456']");
const lines = (document: Document) =>
  [...document.querySelectorAll("path[stroke-dasharray]")].map((path) => path.getAttribute("d"));

it("lays a band over its values and its time, with its number as printed", () => {
  const document = drawn(MARK);
  expect(numbers(ground(document), "x", "y", "width", "height")).toEqual([200, 70, 200, 50]);
  expect(lines(document)).toEqual(["M200 120L400 120", "M200 70L400 70"]);
  expect(texts(document)).toEqual(["printed: 2 micron"]);
});

it("cuts a band where the picture ends, and leaves out what is not in sight or has no axis", () => {
  const document = drawn({ ...MARK, from_tick: 500, until_tick: null, low: -9 });
  expect(numbers(ground(document), "x", "y", "width", "height")).toEqual([100, 70, 400, 150]);
  for (const change of [
    { from_tick: 2001, until_tick: null },
    { until_tick: 999, from_tick: 0 },
    { signal: "drive.voltage" },
  ])
    expect(ground(drawn({ ...MARK, ...change }))).toBeNull();
});

it("draws a line at each value, and upright at a moment", () => {
  const bare = { ...MARK, low: null, high: null };
  expect(lines(drawn({ ...bare, kind: "value", values: [1, 3] }))).toEqual(["M200 170L400 170", "M200 70L400 70"]);
  expect(lines(drawn({ ...bare, kind: "moment", from_tick: 1500, until_tick: 1500 }))).toEqual(["M300 20L300 220"]);
});

it("says a number alone where there is little room, and nothing over another", () => {
  expect(texts(drawn({ ...MARK, number: "2", until_tick: 1300 }))).toEqual(["2"]);
  expect(texts(drawn({ ...MARK, until_tick: 1260 }))).toEqual([]);
  expect(texts(drawn(MARK, MARK))).toHaveLength(1);
});

it("lets an axis reach for marks that are near and in sight", () => {
  expect(reachMarks([0, 2], [MARK], "um", SPAN)).toEqual([0, 3]);
  expect(reachMarks([0, 2], [MARK], "V", SPAN)).toEqual([0, 2]);
  expect(reachMarks([0, 0.1], [MARK], "um", SPAN)).toEqual([0, 0.1]);
  expect(reachMarks([0, 2], [MARK], "um", { start: 0, end: 1000 })).toEqual([0, 2]);
});
