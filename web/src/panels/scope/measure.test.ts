import { expect, it } from "vitest";
import { type Columns, measure, referenceFor } from "./measure";

const DT = 0.01;
const samples = (count: number, of: (t: number) => number): Columns => {
  const values = Float64Array.from({ length: count }, (_, i) => of(i * DT));
  return { low: values, high: values };
};
const sine = (amplitude: number, kHz: number, degrees = 0, offset = 0) =>
  samples(1000, (t) => offset + amplitude * Math.sin(2 * Math.PI * kHz * t - (degrees * Math.PI) / 180));

it("gives a sine its rms, peak and frequency, whatever its offset", () => {
  const found = measure(sine(3, 1.7, 40), DT);
  expect(found?.rms).toBeCloseTo(3 / Math.sqrt(2), 2);
  expect(found?.peak).toBeCloseTo(3, 2);
  expect(found?.frequency).toBeCloseTo(1.7, 3);
  expect(measure(sine(1, 2.4, 0, 5), DT)?.frequency).toBeCloseTo(2.4, 3);
});

it("gives the lag and the ratio to a reference of the same frequency", () => {
  const found = measure(sine(1.5, 2, 65), DT, sine(1, 2));
  expect(found?.phaseLag).toBeCloseTo(65, 1);
  expect(found?.ratio).toBeCloseTo(1.5, 3);
  expect(measure(sine(1, 2, -30), DT, sine(1, 2))?.phaseLag).toBeCloseTo(-30, 1);
});

it("gives a step response of second order its overshoot and settling time", () => {
  // 1 - e^{-a t} (cos w t + a/w sin w t) peaks at t = pi/w, by e^{-a pi / w}
  const [a, w] = [1.2, 5];
  const step = samples(1000, (t) => 2 * (1 - Math.exp(-a * t) * (Math.cos(w * t) + (a / w) * Math.sin(w * t))));
  const found = measure(
    step,
    DT,
    samples(1000, () => 2),
  );
  expect(found?.overshoot).toBeCloseTo(Math.exp((-a * Math.PI) / w), 3);
  // the envelope e^{-a t} sqrt(1 + (a/w)^2) enters the band of 2 % at 3.28 ms; the response a little before that
  const bound = Math.log(Math.sqrt(1 + (a / w) ** 2) / 0.02) / a;
  expect(found?.settling).toBeLessThanOrEqual(bound + DT);
  expect(found?.settling).toBeGreaterThan(bound - Math.PI / w);
});

it("says nothing about what cannot be seen: no crossing, not settled, no reference, no data", () => {
  const flat = measure(
    samples(100, () => 4),
    DT,
  );
  expect(flat).toMatchObject({ rms: 4, peak: 4, frequency: undefined, phaseLag: undefined, overshoot: undefined });
  expect(measure(sine(2, 1), DT, sine(1, 1))?.settling).toBeUndefined();
  const nothing = Float64Array.of(Number.NaN, Number.NaN);
  expect(measure({ low: nothing, high: nothing }, DT)).toBeUndefined();
});

it("takes the mean square of a column as that of a line through it", () => {
  expect(measure({ low: [-3], high: [3] }, DT)?.rms).toBeCloseTo(Math.sqrt(3), 9);
});

it("lets voltages follow the reference and displacements the model, of the same unit", () => {
  const traces = [
    { name: "plant.displacement", unit: "um" },
    { name: "model.displacement", unit: "um" },
    { name: "drive.voltage", unit: "V" },
  ];
  expect(referenceFor("plant.displacement", "um", traces)).toBe(1);
  expect(referenceFor("model.displacement", "um", traces)).toBeUndefined();
  expect(referenceFor("drive.voltage", "V", traces)).toBeUndefined();
});
