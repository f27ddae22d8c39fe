import { expect, it } from "vitest";
import { squareField } from "./paint-phase";

it.each([
  [900, 240],
  [240, 900],
  [390, 420],
  [81, 81],
  [1600, 1000],
])("the plane is square and in the middle of what the axes leave of %i by %i px", (width, height) => {
  const { left, top, right, bottom } = squareField(width, height, 12);
  expect(right - left).toBe(bottom - top);
  expect(Math.abs(left - 58 - (width - 12 - right))).toBeLessThanOrEqual(1);
  expect(Math.abs(top - 20 - (height - 38 - bottom))).toBeLessThanOrEqual(1);
  expect(right - left).toBe(Math.min(width - 70, height - 58));
});
