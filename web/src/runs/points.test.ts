import { expect, it } from "vitest";
import type { PointTally } from "../api/types";
import { delayLine, numericAxes, pointName, trend, usualMetrics } from "./points";

const figure = (mean: number, std = 0) => ({ count: 4, mean, std, min: mean, max: mean });
const point = (noise: number, kind: string, mean: number): PointTally => ({
  labels: { "sensor.noise_um": noise, "controller.kind": kind },
  runs: 4,
  ok: 4,
  tripped: 0,
  errors: [],
  warnings: [],
  metrics: { "control.rms_error_um": figure(mean, 0.1), "device.f0_hz": figure(2000) },
  diagnosis: {},
});
const POINTS = [point(0.6, "pid", 3), point(0.05, "pid", 1), point(0.6, "mrac", 2), point(0.05, "mrac", 0.5)];

it("names a point by what it differs in", () => {
  expect(pointName(POINTS[0].labels)).toBe("noise 0.6\u00a0µm, kind pid");
  expect(pointName({})).toBe("all runs");
  expect(pointName({ variant: "cold" })).toBe("cold");
});

it("begins with the usual figures", () => {
  expect(usualMetrics(POINTS)).toEqual(["control.rms_error_um"]);
});

it("draws a figure over a number, in its order, one line for each of the rest", () => {
  expect(numericAxes(POINTS)).toEqual(["sensor.noise_um"]);
  const lines = trend(POINTS, "sensor.noise_um", "control.rms_error_um");
  expect(lines.map((line) => line.name)).toEqual(["kind pid", "kind mrac"]);
  expect(lines[0]).toMatchObject({ x: [0.05, 0.6], y: [1, 3], spread: [0.1, 0.1] });
});

it("counts delays up to the share that was ever found", () => {
  const tally = { names: [], confusion: [], delays: { "30": 1, "4": 2 }, missed: 1, roc: null };
  expect(delayLine("kalman", tally)).toEqual({ name: "kalman", x: [0, 4, 30], y: [0, 0.5, 0.75], isStepped: true });
});
