import { expect, it } from "vitest";
import { PRESETS, presetLabel, REPLAY_SPEEDS, scaleMarks, sliderToTimeScale, speedItems } from "../bench/time-scale";
import { bandItems, tickItems } from "../panels/spectrum/spectrum-menus";
import { TIME_WINDOWS_MS, windowItems } from "../ui/time-axis";

/** Labels as people read them, with ordinary spaces. */
const labels = (items: readonly { label: string }[]) => items.map(({ label }) => label.replaceAll("\u00a0", " "));

const SIZE: Record<string, number> = {
  µs: 1e-3,
  ms: 1,
  s: 1e3,
  "µs/s": 1e-6,
  "ms/s": 1e-3,
  Hz: 1e-3,
  kHz: 1,
  MHz: 1e3,
};
const UNIT = /^(?:to )?(\d+(?:\.\d+)?) (\S+)$/;

/** The value of a label, in ms, kHz, or as a share. */
function said(label: string): number {
  const [, number, unit] = UNIT.exec(label) ?? [];
  expect(SIZE[unit], label).toBeDefined();
  expect(Number(number), label).toBeLessThan(1000);
  return Number(number) * SIZE[unit];
}

it.each(Object.entries(TIME_WINDOWS_MS))("every time window of the %s says its length", (_, windows) => {
  const items = windowItems(windows, windows[0]);
  expect(items.map(({ value }) => Number(value))).toEqual(windows);
  labels(items).forEach((label, i) => {
    expect(said(label) / windows[i], label).toBeCloseTo(1, 9);
  });
});

it("reads, all of them", () => {
  const [scope, lanes, phase] = Object.values(TIME_WINDOWS_MS).map((windows) =>
    labels(windowItems(windows, windows[0])),
  );
  expect(scope.join(", ")).toBe("200 µs, 500 µs, 1 ms, 2 ms, 4 ms, 10 ms, 20 ms, 50 ms, 100 ms, 200 ms, 500 ms, 1 s");
  expect(lanes.join(", ")).toBe("2 ms, 4 ms, 10 ms, 20 ms, 50 ms, 100 ms, 200 ms, 500 ms");
  expect(phase.join(", ")).toBe("1 ms, 2 ms, 4 ms, 10 ms, 20 ms, 40 ms");
  expect(labels(speedItems()).join(", ")).toBe("0.01 ×, 0.02 ×, 0.05 ×, 0.1 ×, 0.2 ×, 0.5 ×, 1 ×, 2 ×, 5 ×, 10 ×");
  expect(labels(tickItems()).join(", ")).toBe("512 ticks, 1024 ticks, 2048 ticks, 4096 ticks");
  expect(labels(PRESETS.map((scale) => ({ label: presetLabel(scale) }))).join(", ")).toBe(
    "2 ms/s, Real time, As fast as possible",
  );
  expect(labels(scaleMarks()).join(", ")).toBe("1 µs/s, 1 ms/s, real time");
});

it("keeps a window that is not usual, in its place", () =>
  expect(labels(windowItems([1, 2, 4], 3.2))).toEqual(["1 ms", "2 ms", "3.2 ms", "4 ms"]));

it.each([0.01, 0.001, 0.005, 1])("says how far the band reaches with samples %s ms apart", (dtMs) => {
  for (const { value, label } of bandItems(dtMs))
    expect(said(label.replaceAll("\u00a0", " ")) / (0.5 / dtMs / Number(value)), label).toBeCloseTo(1, 3);
});

it("says every speed of a replay, and every stop of the slider of time scales", () => {
  for (const { value, label } of speedItems()) expect(Number(label.split("\u00a0")[0])).toBe(Number(value));
  expect(speedItems()).toHaveLength(REPLAY_SPEEDS.length);
  for (let position = 0; position < 1; position += 0.01) {
    const scale = sliderToTimeScale(position);
    if (scale < 1)
      expect(said(presetLabel(scale).replaceAll("\u00a0", " ")) / scale, presetLabel(scale)).toBeCloseTo(1, 9);
  }
});
