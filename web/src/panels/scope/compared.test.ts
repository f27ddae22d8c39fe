import { expect, it } from "vitest";
import { comparedOf } from "./compared";
import type { PlotTrace } from "./paint-scope";

const trace = (name: string, rest: Partial<PlotTrace> = {}): PlotTrace => ({
  name,
  unit: "deg/s",
  slot: 0,
  colour: "",
  dash: 0,
  ...rest,
});
const spaced = (text: string) => text.replaceAll(/\s/g, " ");

it("compares the controller that drives with the one that drove before", () => {
  const traces = [
    trace("rate.rate"),
    trace("rebalance.rate", { drives: [{ name: "rebalance", from: 500, until: Number.POSITIVE_INFINITY }] }),
    trace("open.rate", { drives: [{ name: "open", from: 0, until: 500 }] }),
  ];
  const figures = { before: [100, 0.1, 76], after: [100, 99, 0.3], settled: [true, true, true] };
  const said = comparedOf(traces, figures, 500).map(({ trace: { name }, before, after }) => [name, before, after]);
  expect(said.map((one) => one.map(spaced))).toEqual([
    ["rebalance.rate", "76.0 deg/s", "99.0 deg/s"],
    ["rate.rate", "100 deg/s", "100 deg/s"],
  ]);
});

it.each([
  [2.21, 0.5, "shifted by +500 nm"],
  [2.21, -0.5, "shifted by −500 nm"],
  [4.3, 0.5, "2.0 times larger"],
  [2.15, 0.01, "unchanged"],
])("says a shift where the mean moves more than the RMS changes: %s µm and %s µm", (now, moved, said) => {
  const figures = { before: [2.15], after: [now], settled: [true], shift: [moved] };
  const [{ ratio }] = comparedOf([trace("sensor.displacement", { unit: "um" })], figures, 500);
  expect(spaced(ratio)).toBe(said);
});

it("says no shift that the noise hides", () => {
  const noise: [number, number][] = [[0.7, 1.6]];
  const figures = { before: [1.62], after: [1.6], settled: [true], shift: [-0.17], noise };
  const said = comparedOf([trace("model.error", { unit: "nm" })], figures, 500);
  expect(said.map(({ measure, ratio }) => [measure, spaced(ratio)])).toEqual([
    ["noise", "2.3 times larger"],
    ["RMS", "1.2 % smaller"],
  ]);
});

it("puts a shifted trace before one that stays", () => {
  const figures = { before: [2.15, 2.15], after: [2.15, 2.21], settled: [true, true], shift: [0, 0.5] };
  const traces = [trace("plant.displacement", { unit: "um" }), trace("sensor.displacement", { unit: "um" })];
  expect(comparedOf(traces, figures, 500).map((one) => one.trace.name)).toEqual([
    "sensor.displacement",
    "plant.displacement",
  ]);
});

it("says the noise where the RMS of a sine hides it", () => {
  const figures = { before: [1.41], after: [1.42], settled: [true], noise: [[0.05, 0.15] as [number, number]] };
  const all = comparedOf([trace("sensor.displacement", { unit: "um" })], figures, 500);
  expect(all.map((one) => [one.measure, one.before, one.after, one.ratio].map(spaced))).toEqual([
    ["noise", "50.0 nm", "150 nm", "3.0 times larger"],
    ["RMS", "1.41 µm", "1.42 µm", "0.7 % larger"],
  ]);
});

it.each([
  [0, 0.15, "appeared"],
  [0.15, 0, "gone"],
])("says that a noise of %s µm is one of %s µm: %s", (quiet, loud, said) => {
  const noise: [number, number][] = [[quiet, loud]];
  const [{ ratio }] = comparedOf(
    [trace("x", { unit: "um" })],
    { before: [1], after: [1], settled: [true], noise },
    500,
  );
  expect(ratio).toBe(said);
});

it.each([
  ["grew no more than the signal", [1, 3], [0.05, 0.1]],
  ["is small beside the signal", [10, 10], [0.05, 0.09]],
  ["remains of an error that a controller has removed", [206, 15], [0.7, 15]],
])("leaves out a noise that %s", (_, [before, after], [quiet, loud]) => {
  const noise: [number, number][] = [[quiet, loud]];
  const figures = { before: [before], after: [after], settled: [true], noise };
  expect(comparedOf([trace("x", { unit: "um" })], figures, 500).map(({ measure }) => measure)).toEqual(["RMS"]);
});
