// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import type { Marks } from "../bench/marks";
import { type EventAxis, markEvents } from "./event-marks";
import { PICTURE_WIDTH, type Picture, pictureSvg } from "./picture";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const event = (seq: number, tick: number, kind = "inject") => ({
  seq,
  tick,
  time_ms: tick * 0.01,
  kind,
  text: `fault ${seq}`,
  actor: "page",
});
const axis = (...events: ReturnType<typeof event>[]): EventAxis => ({
  span: { start: 0, end: 1000 },
  dtMs: 0.01,
  marks: { events, faults: [{ name: "added_mass", severity: 0.05, start: -50, end: 250 }] } as unknown as Marks,
  field: ({ width, height }) => ({ left: 0, right: width, top: 0, bottom: height }),
});
const LOOK = { scheme: "light", fontSize: 12 } as const;
const PLAIN: Picture = { stem: "p", title: "A < B", height: 100, paint: () => undefined };
const drawn = (picture: Partial<Picture>) =>
  new DOMParser().parseFromString(pictureSvg({ ...PLAIN, ...picture }), "image/svg+xml");
const texts = (document: Document) => [...document.querySelectorAll("text")].map((node) => node.textContent ?? "");

it("has a title, titled axes and a legend around what the painter draws", () => {
  const document = drawn({
    across: "frequency, kHz",
    up: "amplitude, µm",
    legend: [{ name: "fitted", colour: "#0072b2", dashes: [5, 4] }],
    paint: (pen, { width, height }) => pen.fillRect(0, 0, width, height),
  });
  expect(document.querySelector("parsererror")).toBeNull();
  expect(document.querySelector("title")?.textContent).toBe("A < B");
  expect(texts(document)).toEqual(["A < B", "fitted", "frequency, kHz", "amplitude, µm"]);
  expect(document.querySelector("path")?.getAttribute("stroke-dasharray")).toBe("5 4");
  // the plot lies within the picture, with room for both titles
  const plot = document.querySelector("g > rect");
  const [, left, top] = /translate\((\S+) (\S+)\)/.exec(plot?.parentElement?.getAttribute("transform") ?? "") ?? [];
  expect(Number(left) + Number(plot?.getAttribute("width"))).toBeLessThan(PICTURE_WIDTH);
  expect(Number(top) + 100 + 24).toBeLessThan(Number(document.documentElement.getAttribute("height")));
});

it("numbers the events of the span on the plot, tells them below, and bands the faults", () => {
  const document = drawn({ time: axis(event(3, 500), event(4, 2000), event(5, 600, "pause")) });
  expect(texts(document)).toEqual(["A < B", "3", "time of the device, ms", "3", "at 5.000\u00a0ms: fault 3"]);
  const width = PICTURE_WIDTH - 32;
  expect(document.querySelector("g path")?.getAttribute("d")).toBe(`M${width / 2 + 0.5} 0L${width / 2 + 0.5} 100`);
  expect(document.querySelector("g rect")?.getAttribute("width")).toBe(String(width / 4));
});

it("says an event in words, also when another follows at the same place", () => {
  const axisOf = axis(event(1, 300), event(2, 301), event(3, 500), event(4, 520));
  const found = texts(
    drawn({
      paint: (pen, { width, height }) =>
        markEvents(pen, axisOf, axisOf.field({ width, height }, LOOK), LOOK, ({ text }) => text),
    }),
  );
  expect(found).toEqual(["A < B", "fault 1", "fault 3", "fault 4"]);
});

it("says an event at the right edge before its line, and never by a number", () => {
  const axisOf = axis(event(1, 960), event(2, 975));
  const found = texts(
    drawn({
      paint: (pen, { width, height }) =>
        markEvents(pen, axisOf, axisOf.field({ width, height }, LOOK), LOOK, ({ text }) => text),
    }),
  );
  expect(found).toEqual(["A < B", "fault 1"]);
});

it("joins the numbers of events that lie close, and does not list without end", () => {
  const many = Array.from({ length: 14 }, (_, i) => event(i + 1, 500 + i));
  const found = texts(drawn({ time: axis(...many) }));
  expect(found.filter((text) => /–/.test(text))).toEqual(["1–14"]);
  expect(found).toContain("at 5.110\u00a0ms: fault 12");
  expect(found).not.toContain("at 5.120\u00a0ms: fault 13");
  expect(found.at(-1)).toBe("and 2 more");
});
