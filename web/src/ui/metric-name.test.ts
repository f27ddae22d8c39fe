import { expect, it } from "vitest";
import { micro } from "../api/micro";
import cases from "./metric-cases.json";
import { metricLimits, metricName, metricScale, metricTitle } from "./metric-name";

it("says a metric in words and keeps whose it is", () => {
  expect(metricName("diagnosis.kalman.correct_fraction")).toBe("kalman correct fraction");
  expect(metricName("control.effort_ratio")).toBe("effort ratio");
  expect(metricName("twins.healthy.control.effort_ratio")).toBe("healthy: control effort ratio");
  expect(metricName("beam_width.softer_5_um_pct")).toBe("beam width softer 5 µm %");
});

it.each(Object.entries(cases))("titles %s as reports do: %s", (metric, title) =>
  expect(metricTitle(metric)).toBe(title));

it("shows figures in a unit that needs no power of ten, and leaves those that read well", () => {
  const mass = metricScale("device.mass_kg", [220.9e-12]);
  expect([mass.title, mass.shown(220.9e-12)]).toEqual(["mass, ng", 220.9]);
  const error = metricScale("control.rms_error_um", [0.02, null, 0.5, undefined]);
  expect([error.name, error.unit, error.shown(0.02)]).toEqual(["rms error", "µm", 0.02]);
  expect(metricScale("control.effort_ratio", [1e-9]).title).toBe("effort ratio");
});

it("prints the units of a text", () => {
  expect(micro("Beams 0.2 um narrower, h = 20us, a drum")).toBe("Beams 0.2\u00a0µm narrower, h = 20\u00a0µs, a drum");
});

it("writes micro in texts of the server with its sign, and leaves names alone", () => {
  expect(micro("displacement beyond 8 um, in um, 3 um/V, uN um")).toBe(
    "displacement beyond 8\u00a0µm, in µm, 3\u00a0µm/V, µN µm",
  );
  expect(micro("set reference.amplitude_um = 1, tell us, drum")).toBe("set reference.amplitude_um = 1, tell us, drum");
});

it("knows what a figure cannot pass: 0 for counts and sizes, 1 for shares", () => {
  expect(metricLimits("diagnosis.kalman.false_switches")).toEqual([0, Number.POSITIVE_INFINITY]);
  expect(metricLimits("control.rms_error_um")?.[0]).toBe(0);
  expect(metricLimits("diagnosis.kalman.correct_fraction")).toEqual([0, 1]);
  expect(metricLimits("rate.scale_error_pct")).toBeUndefined();
});
