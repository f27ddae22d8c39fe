import { expect, it } from "vitest";
import type { PanelFrame } from "../../stream/panel-frame";
import { differ, noiseOf } from "./noise";

const frameOf = (value: (tick: number) => number, columns = 500) => {
  const samples = Array.from({ length: columns }, (_, tick) => value(tick));
  return { columns, data: Float32Array.from([...samples, ...samples]) } as PanelFrame;
};
const wave = (tick: number, period = 50) => Math.sin((2 * Math.PI * tick) / period + 0.3);
/** Numbers from -0.5 to 0.5 in no order, by the congruence of Park and Miller. */
const shuffled = (() => {
  let state = 1;
  return Array.from({ length: 4096 }, () => {
    state = (48271 * state) % 2147483647;
    return state / 2147483647 - 0.5;
  });
})();
/** The standard deviation of a uniform number of width 1. */
const UNIFORM = 1 / Math.sqrt(12);

it("leaves nothing of a mean, a tone and its harmonics", () => {
  const signal = (tick: number) => 3 + 2 * wave(tick) + 0.4 * wave(tick, 25) + 0.2 * wave(tick, 10);
  expect(noiseOf(frameOf(signal), 0, 50).rms).toBe(0);
  expect(
    noiseOf(
      frameOf((tick) => 2 * wave(tick, 25.477), 255),
      0,
      25.477,
    ).rms,
  ).toBe(0);
  expect(
    noiseOf(
      frameOf(() => 3),
      0,
      null,
    ).rms,
  ).toBe(0);
});

it("leaves a tone that is no harmonic: its amplitude over the square root of two", () => {
  const { rms, likeness } = noiseOf(
    frameOf((tick) => 2 * wave(tick) + 0.3 * wave(tick, 500 / 37)),
    0,
    50,
  );
  // of 500 samples 11 are spent on the fit
  expect(rms).toBeCloseTo((0.3 / Math.SQRT2) * Math.sqrt(500 / 489), 5);
  expect(likeness).toBeCloseTo(Math.cos((2 * Math.PI * 37) / 500), 1);
});

it.each([
  50,
  25.477,
  null,
])("finds the deviation of white noise under a sine of period %s, within its spread", (period) => {
  const sine = (tick: number) => (period ? 2 * wave(tick, period) : 2);
  for (let from = 0; from < 3500; from += 500) {
    const { rms, spread, likeness } = noiseOf(
      frameOf((tick) => sine(tick) + 0.2 * shuffled[from + tick]),
      0,
      period,
    );
    expect(Math.abs(rms - 0.2 * UNIFORM)).toBeLessThan(4 * spread);
    // of N samples of white noise the RMS is known to 1/sqrt(2 N), and better where no sample is far out
    expect(spread / rms).toBeLessThan(1.6 / Math.sqrt(1000));
    expect(Math.abs(likeness)).toBeLessThan(0.2);
  }
});

it("tells a larger noise from the same noise", () => {
  const noise = (size: number, from: number) =>
    noiseOf(
      frameOf((tick) => 2 * wave(tick) + size * shuffled[from + tick]),
      0,
      50,
    );
  for (let from = 0; from < 3000; from += 500) {
    expect(differ(noise(0.1, from), noise(0.1, from + 500))).toBe(false);
    expect(differ(noise(0.1, from), noise(0.15, from + 500))).toBe(true);
    expect(differ(noise(0.15, from), noise(0.1, from + 500))).toBe(true);
  }
  expect(differ(noise(0, 0), noise(0.1, 0))).toBe(true);
  expect(differ(noise(0, 0), noise(0, 500))).toBe(false);
});

it("takes an oscillation that decays for motion, not for noise", () => {
  const quiet = noiseOf(
    frameOf((tick) => 2 * wave(tick) + 0.05 * shuffled[tick]),
    0,
    50,
  );
  const ringing = (tick: number) =>
    2 * wave(tick) + 0.05 * shuffled[tick] + 0.3 * Math.exp(-tick / 900) * wave(tick, 41);
  const rings = noiseOf(frameOf(ringing), 0, 50);
  expect(rings.rms).toBeGreaterThan(5 * quiet.rms);
  expect(differ(quiet, rings)).toBe(false);
});
