import { expect, it } from "vitest";
import { nextRange, roundRange } from "./axis-range";

it("rounds outwards and leaves a little air", () => {
  const { min, max } = roundRange(-3.05, 3.05);
  expect(min).toBeLessThanOrEqual(-3.05 * 1.06);
  expect(max).toBeGreaterThanOrEqual(3.05 * 1.06);
  expect(max - min).toBeLessThan(9);
});

it("gives a flat line room", () => {
  const flat = roundRange(0, 0);
  expect(flat.max).toBeGreaterThan(flat.min);
  const ten = roundRange(10, 10);
  expect(ten.min).toBeLessThan(10);
  expect(ten.max).toBeGreaterThan(10);
});

it("grows at once, shrinks only after it has been loose for a while", () => {
  let range = nextRange(undefined, -1, 1, 0);
  range = nextRange(range, -1, 8, 10);
  expect(range.max).toBeGreaterThanOrEqual(8);
  range = nextRange(range, -1, 1, 20);
  expect(range.max).toBeGreaterThanOrEqual(8);
  expect(nextRange(range, -1, 1, 1000).max).toBeGreaterThanOrEqual(8);
  expect(nextRange(range, -1, 1, 1300).max).toBeLessThan(3);
});

it("forgets that it was loose when the data fill it again", () => {
  let range = nextRange(undefined, -4, 4, 0);
  range = nextRange(range, -1, 1, 10);
  range = nextRange(range, -4, 4, 20);
  expect(range.looseSince).toBeUndefined();
});

it("keeps what it had while there is no data", () => {
  const range = nextRange(undefined, -2, 2, 0);
  expect(nextRange(range, Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY, 10)).toBe(range);
});
