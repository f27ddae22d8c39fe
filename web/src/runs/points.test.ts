import { expect, it } from "vitest";
import { delayLine, pointName } from "./points";

it("names a point by what it differs in", () => {
  expect(pointName({ "sensor.noise_um": 0.6, "controller.kind": "pid" })).toBe("noise 0.6\u00a0µm, kind pid");
  expect(pointName({})).toBe("all runs");
  expect(pointName({ variant: "cold" })).toBe("cold");
});

it("counts delays up to the share that was ever found", () => {
  const tally = { names: [], confusion: [], delays: { "30": 1, "4": 2 }, missed: 1, roc: null };
  expect(delayLine("kalman", tally)).toEqual({ name: "kalman", x: [0, 4, 30], y: [0, 0.5, 0.75], isStepped: true });
});
