import { expect, it } from "vitest";
import { stripRange } from "./paint-strips";

it("holds all values with room, on round ends", () => {
  const [low, high] = stripRange([0.2, 0.81, Number.NaN]);
  expect(low).toBeLessThan(0.2);
  expect(high).toBeGreaterThan(0.81);
  expect(stripRange([0.21, 0.8])).toEqual([low, high]);
});

it("has a width even for a constant and for nothing", () => {
  const [low, high] = stripRange([2, 2]);
  expect(high).toBeGreaterThan(low);
  expect(stripRange([Number.NaN])).toEqual([-1, 1]);
});
