import { expect, it } from "vitest";
import cases from "./metric-cases.json";
import { metricName, metricTitle } from "./metric-name";

it("says a metric in words and keeps whose it is", () => {
  expect(metricName("diagnosis.kalman.correct_fraction")).toBe("kalman correct fraction");
  expect(metricName("control.effort_ratio")).toBe("effort ratio");
  expect(metricName("twins.healthy.control.effort_ratio")).toBe("healthy: control effort ratio");
  expect(metricName("beam_width.softer_5_um_pct")).toBe("beam width softer 5 µm %");
});

it.each(Object.entries(cases))("titles %s as reports do: %s", (metric, title) =>
  expect(metricTitle(metric)).toBe(title));
