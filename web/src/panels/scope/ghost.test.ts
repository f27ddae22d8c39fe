import { expect, it } from "vitest";
import type { PanelFrame } from "../../stream/panel-frame";
import { ghostOn } from "./ghost";

/** A frame of one signal, with the least and the largest value in each column. */
function frameOf(value: (tick: number) => number, startTick: number, endTick: number, columns = endTick - startTick) {
  const per = (endTick - startTick) / columns;
  const held = (c: number) => Array.from({ length: per }, (_, k) => value(startTick + c * per + k));
  const all = Array.from({ length: columns }, (_, c) => held(c));
  const data = [...all.map((ticks) => Math.min(...ticks)), ...all.map((ticks) => Math.max(...ticks))];
  return { signals: 1, columns, startTick, endTick, data: Float32Array.from(data) } as PanelFrame;
}
const wave = (period: number) => (tick: number) => Math.sin((2 * Math.PI * tick) / period);
const CHANGE = 1000;

it.each([
  50, 25.4,
])("draws the last periods before a change in the phase of the live trace, with %d ticks each", (period) => {
  const frame = frameOf(wave(period), CHANGE - 480, CHANGE);
  const { low, high } = ghostOn(
    { frame, since: CHANGE, period },
    frameOf(() => 0, 3217, 3617),
    0,
  );
  const apart = low.map((value, c) => Math.abs(value - wave(period)(3217 + c)));
  expect(Math.max(...apart)).toBeLessThan(0.02);
  expect(high).toEqual(low);
});

it("draws nothing before the change", () => {
  const frame = frameOf(wave(50), CHANGE - 450, CHANGE);
  const { low } = ghostOn(
    { frame, since: CHANGE + 20, period: 50 },
    frameOf(() => 0, CHANGE - 100, CHANGE + 100),
    0,
  );
  expect(low.findIndex((value) => !Number.isNaN(value))).toBe(120);
  expect(low[120]).toBeCloseTo(wave(50)(CHANGE + 20), 4);
});

it("lets the ghost of a drive without a period end at the newest sample", () => {
  const frame = frameOf((tick) => tick, CHANGE - 400, CHANGE);
  const { low } = ghostOn(
    { frame, since: CHANGE, period: null },
    frameOf(() => 0, 4600, 5000),
    0,
  );
  expect([low[0], low[399]]).toEqual([600, 999]);
});

it("takes the least and the largest of all samples of a column", () => {
  const frame = frameOf(wave(50), CHANGE - 1050, CHANGE);
  const { low, high } = ghostOn(
    { frame, since: CHANGE, period: 50 },
    frameOf(() => 0, 4000, 5000, 20),
    0,
  );
  expect(Math.min(...high)).toBeCloseTo(wave(50)(12), 2);
  expect(Math.max(...low)).toBeCloseTo(-wave(50)(12), 2);
});
