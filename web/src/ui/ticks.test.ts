import { expect, it } from "vitest";
import { decadeTicks, linearTicks } from "./ticks";

it("puts round values across a range", () => {
  expect(linearTicks(-43, 17, 6)).toEqual([-40, -30, -20, -10, 0, 10]);
  expect(linearTicks(0, 1, 5)).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
  expect(linearTicks(2, 2, 5)).toEqual([]);
});

it("marks 1, 2 and 5 of every decade", () => {
  expect(decadeTicks(200, 20_000)).toEqual([200, 500, 1000, 2000, 5000, 10_000, 20_000]);
});
