import { expect, it } from "vitest";
import { locusAxes } from "./locus-axes";

const points = (x: number[], y: number[]) => ({ x: Float32Array.from(x), y: Float32Array.from(y) });

it("keeps one scale, so that an angle is seen as it is", () => {
  const { x, y } = locusAxes(undefined, [points([-5, 5], [-0.05, 0.05])], false);
  expect(y).toEqual(x);
  expect(x[1]).toBeCloseTo(5.4);
});

it("stretches y alone, and holds the widest trace", () => {
  const { x, y } = locusAxes(undefined, [points([-5, 4], [0, 0.05]), points([0, 2], [-0.1, 0])], true);
  expect(x[0]).toBeCloseTo(-5.4);
  expect(y[1]).toBeCloseTo(0.108);
});

it("shows an axis before anything has moved", () => {
  expect(locusAxes(undefined, [points([], [])], false).x[1]).toBeGreaterThan(0);
});
