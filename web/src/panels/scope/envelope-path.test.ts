import { afterEach, beforeEach, expect, it, vi } from "vitest";

vi.mock("uplot", () => ({ default: { pxRatio: 1 } }));

import type uPlot from "uplot";
import { envelopePath } from "./envelope-path";

class FakePath {
  rects: number[][] = [];
  points: [number, number][] = [];
  rect(...args: number[]) {
    this.rects.push(args);
  }
  moveTo(x: number, y: number) {
    this.points.push([x, y]);
  }
  lineTo(x: number, y: number) {
    this.points.push([x, y]);
  }
}

beforeEach(() => vi.stubGlobal("Path2D", FakePath));
afterEach(() => vi.unstubAllGlobals());

function draw(low: number[], high: number[]) {
  const plot = {
    series: [{}, { scale: "y0" }],
    scales: { x: { min: 0, max: low.length - 1 }, y0: { min: 0, max: 10 } },
    data: [low.map((_, i) => i)],
    bbox: { left: 0, top: 0, width: 100, height: 100 },
  } as unknown as uPlot;
  const columns = { low: Float32Array.from(low), high: Float32Array.from(high) };
  const paths = envelopePath(() => columns)(plot, 1, 0, low.length - 1);
  return paths as unknown as { stroke: FakePath; fill: FakePath };
}

it("shows a spike of one tick in full height, however many ticks its column covers", () => {
  const { fill } = draw([1, 1, 1, 1, 1], [1, 1, 9, 1, 1]);
  expect(fill.rects).toHaveLength(1);
  const [x, top, width, height] = fill.rects[0];
  expect([x + width / 2, width]).toEqual([50.5, 1]);
  expect(top).toBeCloseTo(10);
  expect(height).toBeCloseTo(80);
});

it("draws a plain line where columns hold one value, and bridges columns without data", () => {
  const { fill, stroke } = draw([2, Number.NaN, 4], [2, Number.NaN, 4]);
  expect(fill.rects).toEqual([]);
  expect(stroke.points).toEqual([
    [0, 80],
    [100, 60],
  ]);
});
