import { expect, it } from "vitest";
import { positionOf, valueAt } from "./slider-scale";

it("goes there and back, linear and by ratios", () => {
  const linear = { low: 100, high: 800, log: false };
  expect(valueAt(positionOf(350, linear), linear, 1)).toBe(350);
  const log = { low: 0.1, high: 1e6, log: true };
  expect(positionOf(Math.sqrt(0.1 * 1e6), log)).toBeCloseTo(0.5);
  expect(valueAt(positionOf(101_000, log), log, 0)).toBe(101_000);
});

it("stays at its ends for what lies beyond", () => {
  expect(positionOf(900, { low: 100, high: 800, log: false })).toBe(1);
  expect(positionOf(-3, { low: 0.1, high: 10, log: true })).toBe(0);
});
