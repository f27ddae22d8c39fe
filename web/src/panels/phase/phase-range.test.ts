import { expect, it } from "vitest";
import { extent, follow, type Range, union } from "./phase-range";

it("grows at once and shrinks slowly", () => {
  const first = follow(undefined, [-1, 1]);
  expect(first).toEqual([-1.08, 1.08]);
  expect(follow(first, [-1, 5])[1]).toBeGreaterThan(5);
  const smaller = follow(first, [-0.1, 0.1]);
  expect(smaller[1]).toBeLessThan(first[1]);
  expect(smaller[1]).toBeGreaterThan(1);
  let range: Range = first;
  for (let i = 0; i < 400; i += 1) range = follow(range, [-0.1, 0.1]);
  expect(range[1]).toBeCloseTo(0.108, 2);
});

it("never closes on a point, and knows nothing of what is not a number", () => {
  const [low, high] = follow(undefined, [2, 2]);
  expect(high).toBeGreaterThan(low);
  expect(extent([Number.NaN, 3, -1])).toEqual([-1, 3]);
  expect(extent([Number.NaN])).toBeUndefined();
  expect(union([0, 1], [-2, 0.5])).toEqual([-2, 1]);
  expect(union([0, 1], undefined)).toEqual([0, 1]);
});
