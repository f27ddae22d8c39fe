// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import { pictureSvg } from "../../picture/picture";
import { drawRegions } from "./paint-regions";
import { drawSets, reachOf } from "./paint-sets";
import { peaks, regionsWords } from "./regions";
import { type Behaviour, setsOf, setsWords } from "./sets";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const behaviour = (name: string, x: number, y: number, holds = false): Behaviour => ({
  name,
  words: name,
  from: { x, y },
  holds,
});

it("keeps the first behaviour where it is, and the measured output as far from each as it is", () => {
  const healthy = setsOf([behaviour("healthy", 0.2, -0.1, true), behaviour("m+5", -5, 3)]);
  const faulty = setsOf([behaviour("healthy", 5.2, -3.1), behaviour("m+5", 0, 0, true)]);
  expect(healthy?.discs.map(({ x, y }) => [x, y])).toEqual([
    [0, 0],
    [5.2, -3.1],
  ]);
  expect(faulty?.discs[1]).toEqual(healthy && { ...healthy.discs[1], holds: true });
  expect(faulty?.measured).toEqual({ x: 5.2, y: -3.1 });
});

it("draws nothing before the test has run", () => {
  expect(setsOf([])).toBeUndefined();
  expect(drawSets([behaviour("healthy", Number.NaN, 0)], 0)).toBeUndefined();
  expect(drawRegions({ loss: [Number.NaN], peakUm: [1] }, 0, LIMITS)).toBeUndefined();
});

it("holds every disc and the measured output in a square", () => {
  const { x, y, half } = reachOf({
    discs: [{ name: "healthy", x: 0, y: 0, holds: true }],
    measured: { x: 10, y: -8 },
  });
  for (const [px, py] of [
    [-1, 1],
    [10, -8],
  ]) {
    expect(Math.abs(px - x)).toBeLessThanOrEqual(half);
    expect(Math.abs(py - y)).toBeLessThanOrEqual(half);
  }
});

it("keeps a picture with titled axes, round discs, and a cross in the legend as in the plot", () => {
  const drawing = drawSets([behaviour("healthy", 0.2, -0.1, true), behaviour("m+5", -5, 3)], 1);
  if (!drawing) throw new Error("nothing is drawn");
  const svg = pictureSvg({ stem: "s", title: "Behaviours", height: 600, ...drawing });
  const document = new DOMParser().parseFromString(svg, "image/svg+xml");
  const texts = [...document.querySelectorAll("text")].map((node) => node.textContent);
  expect(texts).toContain("output by the sine of the drive, in limits of the test");
  expect(texts).toContain("measured");
  const crosses = [...document.querySelectorAll("path")].filter((path) =>
    /^M\S+ \S+L\S+ \S+M\S+ \S+L\S+ \S+$/.test(path.getAttribute("d") ?? ""),
  );
  expect(crosses).toHaveLength(3); // its rim and itself in the plot, and the one of the legend
});

it("says which behaviours hold, and the verdict", () => {
  const one = [behaviour("healthy", 3, 0), behaviour("mass +5 %", 0, 0, true)];
  expect(setsWords(one, 2)).toBe(
    "Input and output belong to the behaviour: mass +5 %. The verdict: a fault is isolated.",
  );
  expect(setsWords([behaviour("healthy", 3, 0)], 4)).toBe(
    "Input and output belong to no behaviour of the list. The verdict: an unknown fault.",
  );
  expect(setsWords([behaviour("a", 0, 0, true), behaviour("b", 0, 0, true)], 3)).toContain("the behaviours: a, b.");
});

const LIMITS = { degraded: 0.05, unacceptable: 0.25, danger: 0.6, dangerUm: 4.5 };

it("finds the largest displacement of a period", () => {
  expect(peaks([-1, -4, 0, 0, 0], [2, 1, 1, 0, 3], 3)).toEqual([2, 4, 4, 4, 3]);
});

it("says where the device is", () => {
  const path = { loss: [0.01, 0.12], peakUm: [3, 3.3] };
  expect(regionsWords(path, 1)).toBe(
    "Performance is degraded: 12.0\u00a0% from the healthy motion, at most 3.30\u00a0µm from rest.",
  );
  expect(regionsWords(path, 3)).toMatch(/^The device is in danger: /);
});
