import { expect, it } from "vitest";
import type { Pen } from "../../picture/pen";
import { SvgPen } from "../../picture/svg-pen";
import { differenceOf, magnitudesOf, paintEnvelope, shadeBetween } from "./envelope-path";

/** Keeps the ink instead of writing it down. */
class Notes extends SvgPen {
  points: [number, number][] = [];
  override moveTo(x: number, y: number) {
    this.points.push([x, y]);
  }
  override lineTo(x: number, y: number) {
    this.points.push([x, y]);
  }
}

class Bars {
  fillStyle = "";
  all: { x: number; top: number; width: number; bottom: number }[] = [];
  fillRect(x: number, y: number, width: number, height: number) {
    this.all.push({ x, top: y, width, bottom: y + height });
  }
}

/** A field of 100 px by 100 px over values from 0 to 10. */
function draw(low: number[], high: number[], { width = low.length - 1, dashes = [] as number[], isLine = false } = {}) {
  const pen = new Notes();
  const bars = new Bars();
  const field = { left: 0, top: 0, width, height: 100, from: 0, to: low.length - 1, min: 0, max: 10 };
  const columns = { low: Float32Array.from(low), high: Float32Array.from(high) };
  paintEnvelope(
    pen,
    bars,
    low.map((_, i) => i),
    columns,
    field,
    { colour: "#123456", width: 2, dashes, isLine },
  );
  return { bars: bars.all, points: pen.points };
}

const at = (bars: Bars["all"], x: number) => bars.find((bar) => bar.x <= x && x < bar.x + bar.width);

it("shows a spike of one tick in full height, however many ticks its column covers", () => {
  for (const dashes of [[], [1, 50]]) {
    const { bars } = draw([1, 1, 1, 1, 1], [1, 1, 9, 1, 1], { dashes });
    const spike = bars.toSorted((a, b) => b.bottom - b.top - (a.bottom - a.top))[0];
    expect(spike.top).toBeLessThanOrEqual(10);
    expect(spike.bottom).toBeGreaterThanOrEqual(90);
    expect(Math.abs(spike.x + spike.width / 2 - 2)).toBeLessThanOrEqual(0.5);
  }
});

it("leaves no gap between columns that follow each other, up or down", () => {
  const values = [1, 3, 9, 8, 2, 5];
  const { bars, points } = draw(values, values);
  expect(points).toEqual([]);
  for (let c = 1; c < bars.length; c += 1) {
    expect(bars[c].top).toBeLessThan(bars[c - 1].bottom);
    expect(bars[c].bottom).toBeGreaterThan(bars[c - 1].top);
  }
});

it("draws a line of its width, in the middle of its value", () => {
  const { bars } = draw([4, 4, 4], [4, 4, 4]);
  expect(at(bars, 1)).toMatchObject({ top: 59, bottom: 61 });
});

it("leaves no gap where a pixel has no column of its own", () => {
  const flat = Array(20).fill(5);
  const { bars } = draw(flat, flat, { width: 24 });
  for (let x = 2; x < 23; x += 1) expect(at(bars, x)).toBeDefined();
});

it("joins columns that lie apart by a plain line, and bridges columns without data", () => {
  const { bars, points } = draw([2, Number.NaN, 4], [2, Number.NaN, 4], { width: 100 });
  expect(bars).toEqual([]);
  expect(points).toEqual([
    [0, 80],
    [100, 60],
  ]);
});

it("joins columns of few samples by a line that reaches both ends of each", () => {
  const { bars, points } = draw([1, 3, 6, 2], [1, 5, 6, 5], { isLine: true });
  expect(bars.every(({ top, bottom }) => bottom - top < 40)).toBe(true); // no bar that joins two columns
  expect(points).toEqual([
    [0, 90],
    [0.75, 70],
    [1.25, 50],
    [2, 40],
    [2.75, 50],
    [3.25, 80],
  ]);
});

it("leaves out what lies between dashes", () => {
  const flat = Array(20).fill(5);
  const { bars } = draw(flat, flat, { dashes: [4, 6] });
  const inked = (x: number) => bars.some((bar) => bar.x === x);
  expect([1, 2, 3, 11, 12, 13].every(inked)).toBe(true);
  expect([5, 6, 7, 8, 15, 16, 17, 18].some(inked)).toBe(false);
});

it("stays within its field", () => {
  const { bars } = draw([-50, 3, 60], [-40, 3, 70]);
  for (const { top, bottom } of bars) {
    expect(top).toBeGreaterThanOrEqual(-1);
    expect(bottom).toBeLessThanOrEqual(101);
  }
});

it("a difference is that of the samples, and none where columns hold several", () => {
  const of = (values: number[]) => ({ low: Float32Array.from(values), high: Float32Array.from(values) });
  const [one, other] = [of([3, 1, Number.NaN]), of([1, -1, 0])];
  expect([...differenceOf(one, other, true).high]).toEqual([2, 2, Number.NaN]);
  const several = { low: Float32Array.from([-1, -1]), high: Float32Array.from([1, 1]) };
  expect([...differenceOf(several, several, false).low]).toEqual([Number.NaN, Number.NaN]);
});

it("the area between two traces is filled where both have data", () => {
  const line = (values: number[]) => ({ low: Float32Array.from(values), high: Float32Array.from(values) });
  const fills: number[][][] = [];
  let path: number[][] = [];
  const pen = {
    ...{ save() {}, restore() {}, beginPath: () => (path = []) },
    ...{ moveTo: (x: number, y: number) => path.push([x, y]), lineTo: (x: number, y: number) => path.push([x, y]) },
    fill: () => fills.push(path),
  } as unknown as Pen;
  const field = { left: 0, top: 0, width: 40, height: 10, from: 0, to: 4, min: 0, max: 10 };
  const nothing = Number.NaN;
  shadeBetween(pen, [0, 1, 2, 3, 4], line([1, 2, nothing, 3, 30]), line([5, 5, 5, 5, 5]), field, "#000000");
  expect(fills).toEqual([
    [
      [0, 9],
      [10, 8],
      [10, 5],
      [0, 5],
    ],
    [
      [30, 7],
      [40, 0],
      [40, 5],
      [30, 5],
    ],
  ]);
});

it("logarithms are those of the least and the most magnitude in a column", () => {
  const nothing = Number.NaN;
  const found = magnitudesOf({
    low: Float32Array.from([0.1, -100, -10, 0, nothing]),
    high: Float32Array.from([10, -1, 1, 0, nothing]),
  });
  expect([...found.low].map((v) => Math.round(v * 1e6) / 1e6)).toEqual([-1, 0, -Infinity, -Infinity, nothing]);
  expect([...found.high]).toEqual([1, 2, 1, -Infinity, nothing]);
});
