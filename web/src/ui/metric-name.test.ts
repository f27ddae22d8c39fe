import { expect, it } from "vitest";
import cases from "./metric-cases.json";
import { metricName, metricTitle, metricUnit, micro } from "./metric-name";

it("says a metric in words and keeps whose it is", () => {
  expect(metricName("diagnosis.kalman.correct_fraction")).toBe("kalman correct fraction");
  expect(metricName("control.effort_ratio")).toBe("effort ratio");
  expect(metricName("twins.healthy.control.effort_ratio")).toBe("healthy: control effort ratio");
  expect(metricName("beam_width.softer_5_um_pct")).toBe("beam width softer 5 µm %");
});

it.each(Object.entries(cases))("titles %s as reports do: %s", (metric, title) =>
  expect(metricTitle(metric)).toBe(title));

it("tells the unit of a metric alone", () => {
  expect(metricUnit("control.first_peak_pct")).toBe("%");
  expect(metricUnit("control.effort_ratio")).toBe("");
});

it("prints the units of a text", () => {
  expect(micro("Beams 0.2 um narrower, h = 20us, a drum")).toBe("Beams 0.2\u00a0µm narrower, h = 20\u00a0µs, a drum");
});
