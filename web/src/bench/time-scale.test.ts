import { expect, it } from "vitest";
import { againstRealTime, formatTimeScale, sliderToTimeScale, stepTimeScale, timeScaleToSlider } from "./time-scale";

it("reads as device time per second", () => {
  expect([1e-6, 0.002, 0.05, 1].map(formatTimeScale)).toEqual([
    "1.00\u00a0µs/s",
    "2.00\u00a0ms/s",
    "50.0\u00a0ms/s",
    "1.00\u00a0s/s",
  ]);
  expect(formatTimeScale(null)).toBe("as fast as possible");
});

it("is put against real time", () => {
  expect([0.002, 1, 4, null].map(againstRealTime)).toEqual([
    "500\u00a0× slower than real time",
    "real time",
    "4\u00a0× faster than real time",
    "as fast as the machine can",
  ]);
});

it("doubles and halves within the limits", () => {
  expect(stepTimeScale(0.002, 2)).toBeCloseTo(0.004);
  expect(stepTimeScale(0.8, 2)).toBe(1);
  expect(stepTimeScale(1e-6, 0.5)).toBe(1e-6);
  expect(stepTimeScale(null, 0.5)).toBe(0.5);
});

it("maps the slider to round values and back", () => {
  for (const value of [1e-6, 2e-6, 5e-4, 0.002, 0.1, 1])
    expect(sliderToTimeScale(timeScaleToSlider(value))).toBeCloseTo(value, 9);
});
