import { describe, expect, it } from "vitest";
import type { PanelFrame } from "../../stream/panel-frame";
import { bandsOf, isEnvelope } from "./envelope-rule";

const COLUMNS = 600;

/** Least and largest of a signal of time in ms within each pixel of a window, sampled at 100 kHz. */
function columns(signal: (ms: number) => number, windowMs: number, count = COLUMNS) {
  const ticks = Math.round(windowMs * 100);
  const low = new Float32Array(count).fill(Number.POSITIVE_INFINITY);
  const high = new Float32Array(count).fill(Number.NEGATIVE_INFINITY);
  for (let tick = 0; tick < ticks; tick += 1) {
    const column = Math.floor((tick * count) / ticks);
    const value = signal(tick / 100);
    low[column] = Math.min(low[column], value);
    high[column] = Math.max(high[column], value);
  }
  return { low, high };
}

const tone = (hz: number) => (ms: number) => 3 * Math.sin(2e-3 * Math.PI * hz * ms);

describe("a band is told from a signal", () => {
  it.each([
    ["2 kHz over 10 ms, 30 pixels a period", tone(2000), 10, false],
    ["2 kHz over 40 ms, 7.5 pixels a period", tone(2000), 40, false],
    ["2 kHz over 300 ms, one pixel a period", tone(2000), 300, true],
    ["2 kHz over 2 s", tone(2000), 2000, true],
    ["50 Hz over 300 ms", tone(50), 300, false],
    ["a constant", () => 2, 500, false],
    ["a step", (ms: number) => (ms < 250 ? -3 : 3), 500, false],
    ["a tone that dies away slowly", (ms: number) => Math.exp(-ms / 400) * tone(2000)(ms), 500, true],
    ["a slow tone with a trace of hum", (ms: number) => tone(5)(ms) + 0.01 * tone(2000)(ms), 500, false],
  ])("%s: %s", (_, signal, windowMs, banded) => expect(isEnvelope(columns(signal, windowMs), 8)).toBe(banded));

  it("has no opinion on what was not recorded", () => {
    const nothing = new Float32Array(COLUMNS).fill(Number.NaN);
    expect(isEnvelope({ low: nothing, high: nothing }, 8)).toBe(false);
  });
});

it("says which traces are bands, and how much time a pixel takes", () => {
  const frame = { startTick: 1000, endTick: 51_000, columns: COLUMNS, dtMs: 0.01 } as PanelFrame;
  const range = { min: -4, max: 4, looseSince: undefined };
  const both = [columns(tone(5), 500), columns(tone(2000), 500)];
  const found = bandsOf(frame, both, [range, range]);
  expect(found?.traces).toEqual([1]);
  expect(found?.perPixelMs).toBeCloseTo(500 / 600);
  expect(found?.samples).toBeCloseTo(50_000 / 600);
  expect(bandsOf({ ...frame, endTick: 1600 }, both, [range, range])).toBeUndefined();
});
