import { expect, it } from "vitest";
import cases from "../testing/cases/metric.json";
import { metricScale, metricTitle } from "./metric-name";

it.each(Object.entries(cases))("titles %s as reports do: %s", (metric, title) =>
  expect(metricTitle(metric)).toBe(title));

it("shows figures in a unit that needs no power of ten, and leaves those that read well", () => {
  const mass = metricScale("device.mass_kg", [220.9e-12]);
  expect([mass.title, mass.shown(220.9e-12)]).toEqual(["mass, ng", 220.9]);
  const error = metricScale("control.rms_error_um", [0.02, null, 0.5, undefined]);
  expect([error.name, error.unit, error.shown(0.02)]).toEqual(["rms error", "µm", 0.02]);
  expect(metricScale("control.effort_ratio", [1e-9]).title).toBe("effort ratio");
});

it("says one figure by itself with its own prefix and unit, and with its deviation", () => {
  const error = metricScale("control.rms_error_um", [0.02, 0.0007]);
  expect([error.say(0.02), error.say(0.7091, 0.0007), error.say(undefined)]).toEqual([
    "20.00\u00a0nm",
    "709.10\u00a0±\u00a00.70\u00a0nm",
    "–",
  ]);
  expect(metricScale("diagnosis.kalman.false_switches", []).say(27)).toBe("27");
});
