import { expect, it } from "vitest";
import { linearTicks } from "./ticks";
import { timeLabels, timeUnit } from "./time-axis";

it("picks µs, ms or s by the span", () => {
  expect([0.1, 4, 180, 5000].map((s) => timeUnit(s).unit)).toEqual(["µs", "ms", "ms", "s"]);
});

it("steps by 1, 2 or 5 on round values", () => {
  expect(linearTicks(184.1, 188.1, 5)).toEqual([185, 186, 187, 188]);
  expect(linearTicks(0, 0.02, 4).map((x) => +x.toFixed(6))).toEqual([0, 0.005, 0.01, 0.015, 0.02]);
  expect(linearTicks(3, 3, 5)).toEqual([]);
});

it("labels with the decimals the steps need", () => {
  expect(timeLabels([1, 1.5, 2], 2)).toEqual(["1.0", "1.5", "2.0"]);
  expect(timeLabels([184000, 185000], 4000)).toEqual(["184", "185"]);
  expect(timeLabels([10.02, 10.03], 0.04)).toEqual(["10\u202f020", "10\u202f030"]);
});
