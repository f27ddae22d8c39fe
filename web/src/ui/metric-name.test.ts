import { expect, it } from "vitest";
import { metricName, metricTitle } from "./metric-name";

it("says a metric in words and keeps whose it is", () => {
  expect(metricName("diagnosis.kalman.correct_fraction")).toBe("kalman correct fraction");
  expect(metricName("control.effort_ratio")).toBe("effort ratio");
  expect(metricName("twins.healthy.control.effort_ratio")).toBe("healthy: control effort ratio");
  expect(metricName("beam_width.softer_5_um_pct")).toBe("beam width softer 5 µm %");
});

it("titles an axis with the unit its name ends in", () => {
  expect(metricTitle("noise_um")).toBe("noise, µm");
  expect(metricTitle("device.force_n_per_v")).toBe("force, N/V");
  expect(metricTitle("integral_v_um_ms")).toBe("integral, V/(µm·ms)");
  expect(metricTitle("diagnosis.kalman.mean_delay_samples")).toBe("kalman mean delay, samples");
  expect(metricTitle("diagnosis.kalman.correct_fraction")).toBe("kalman correct fraction");
});
