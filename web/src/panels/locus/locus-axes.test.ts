import { expect, it } from "vitest";
import { locusAxes, tiltDeg } from "./locus-axes";

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

const STEPS = 200;
/** An ellipse of half axes a and b, turned by some degrees, about a centre that is not the origin. */
const ellipse = (a: number, b: number, degrees: number) => {
  const turn = (degrees * Math.PI) / 180;
  const phase = Array.from({ length: STEPS }, (_, i) => (2 * Math.PI * i) / STEPS);
  return {
    x: phase.map((t) => 3 + a * Math.cos(t) * Math.cos(turn) - b * Math.sin(t) * Math.sin(turn)),
    y: phase.map((t) => -1 + a * Math.cos(t) * Math.sin(turn) + b * Math.sin(t) * Math.cos(turn)),
  };
};

it("finds the long axis of an ellipse, whichever way it is turned", () => {
  for (const degrees of [-89, -30, -0.59, 0, 2, 45, 80]) {
    const { x, y } = ellipse(5, 0.2, degrees);
    expect(tiltDeg(x, y)).toBeCloseTo(degrees, 8);
  }
});

it("is the angle of a line with a phase between its parts", () => {
  // y = g x with g of amplitude 0.07 and phase 0.4: tan 2a = 2 Re g / (1 - |g|^2)
  const t = Array.from({ length: STEPS }, (_, i) => (2 * Math.PI * i) / STEPS);
  const found = tiltDeg(
    t.map((p) => Math.sin(p)),
    t.map((p) => 0.07 * Math.sin(p + 0.4)),
  );
  const expected = (90 / Math.PI) * Math.atan((2 * 0.07 * Math.cos(0.4)) / (1 - 0.07 ** 2));
  expect(found).toBeCloseTo(expected, 8);
});

it("says nothing of what stands still or has not come", () => {
  expect(tiltDeg([1, 1, 1, 1], [2, 2, 2, 2])).toBeUndefined();
  expect(tiltDeg([Number.NaN, 1, 2], [0, 1, 2])).toBeUndefined();
});
