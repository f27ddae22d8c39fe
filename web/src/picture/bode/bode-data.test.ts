import { expect, it } from "vitest";
import { dbRange, decibels, nearest } from "./bode-data";

it("counts in decibels and never falls to minus infinity", () => {
  expect(decibels(-10)).toBeCloseTo(20);
  expect(Number.isFinite(decibels(0))).toBe(true);
});

it("gives the axis round ends around zero", () => {
  expect(dbRange([-33, 13.8])).toEqual([-40, 20]);
  expect(dbRange([Number.NaN, 5])).toEqual([0, 10]);
});

it("finds the nearest frequency by ratio", () => {
  expect(nearest([100, 1000, 10_000], 350)).toBe(1);
  expect(nearest([100, 1000, 10_000], 300)).toBe(0);
});
