import { expect, it } from "vitest";
import type { PanelFrame } from "../../stream/panel-frame";
import { hasSettled, lookAt, rms, windowTicks } from "./whole-periods";

const frameOf = (value: (tick: number) => number, columns: number) => {
  const samples = Array.from({ length: columns }, (_, tick) => value(tick));
  return { columns, data: Float32Array.from([...samples, ...samples]) } as PanelFrame;
};

it("takes the root mean square of a sine over whole periods: its amplitude over the square root of two", () => {
  const frame = frameOf((tick) => (tick < 500 ? 3 : 0.2) * Math.sin((2 * Math.PI * tick) / 50 + 0.3), 1000);
  expect(rms(frame, 0, 0, windowTicks(50, 500))).toBeCloseTo(3 / Math.SQRT2, 5);
  expect(rms(frame, 0, 500)).toBeCloseTo(0.2 / Math.SQRT2, 5);
});

it.each([
  [50, 1e6, 500],
  [50, 499, 450],
  [50, 49, 0],
  [25.477, 1e6, 255],
  [900, 1e6, 1800],
  [null, 1e6, 500],
])("a period of %s ticks and %d ticks there make a window of %d", (period, there, ticks) => {
  expect(windowTicks(period, there)).toBe(ticks);
});

it("looks after the first period, and ever less often", () => {
  expect(lookAt(49, 50)).toBe(0);
  expect(lookAt(50, 50)).toBe(50);
  const looks = new Set(Array.from({ length: 100_000 }, (_, elapsed) => lookAt(elapsed, 50)));
  expect(looks.size).toBeLessThan(60);
  for (const elapsed of [51, 760, 99_999]) {
    expect(lookAt(elapsed, 50)).toBeLessThanOrEqual(elapsed);
    expect(lookAt(elapsed, 50)).toBeGreaterThan(elapsed / 1.16);
  }
});

it.each([
  [1, 1.04, 1, true],
  [1, 1.06, 1, false],
  [200, 15, 11.5, true],
  [200, 16, 11.5, false],
])("with %d before the change and %d, then %d after it, settled is %s", (before, earlier, last, settled) => {
  expect(hasSettled(before, earlier, last)).toBe(settled);
});
