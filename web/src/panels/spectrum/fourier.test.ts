import { expect, it } from "vitest";
import { powerOfTwo, spectrum, strongest } from "./fourier";

const sine = (amplitude: number, kHz: number, dt: number, count: number, offset = 0) =>
  Float32Array.from({ length: count }, (_, i) => offset + amplitude * Math.sin(2 * Math.PI * kHz * dt * i + 0.4));

it("reads the amplitude of a sine on a bin, whatever stands beside it at rest", () => {
  const dt = 0.01;
  const found = spectrum(sine(3, (40 * 1) / (1024 * dt), dt, 1024, 7), dt);
  expect(found.amplitude[40]).toBeCloseTo(3, 4);
  expect(found.frequency[40]).toBeCloseTo(40 / 10.24, 9);
  expect(found.amplitude[0]).toBeCloseTo(0, 4);
  expect(found.amplitude[80]).toBeCloseTo(0, 4);
});

it("is the discrete transform of its definition", () => {
  const values = Float32Array.from([1, -2, 0.5, 3, 0, 1, -1, 2]);
  const mean = values.reduce((sum, v) => sum + v, 0) / 8;
  const found = spectrum(values, 1);
  for (let k = 0; k < 4; k += 1) {
    let re = 0;
    let im = 0;
    values.forEach((v, i) => {
      const w = (v - mean) * (0.5 - 0.5 * Math.cos((2 * Math.PI * i) / 8));
      re += w * Math.cos((2 * Math.PI * k * i) / 8);
      im -= w * Math.sin((2 * Math.PI * k * i) / 8);
    });
    expect(found.amplitude[k]).toBeCloseTo((4 * Math.hypot(re, im)) / 8, 6);
  }
});

it("finds the strongest tone between the bins", () => {
  const dt = 0.01;
  const found = strongest(spectrum(sine(2, 2.03, dt, 3000), dt));
  expect(found?.frequency).toBeCloseTo(2.03, 4);
  expect(found?.amplitude).toBeCloseTo(2, 3);
  expect(strongest(spectrum(new Float32Array(64), dt))).toBeUndefined();
  expect(powerOfTwo(3000)).toBe(2048);
});
