import { expect, it } from "vitest";
import type { Signal } from "../../api/types";
import type { Instance } from "./instances";
import { ownSignals } from "./own-signals";

const signal = (name: string, block: string, index: number): Signal => ({
  name,
  block,
  index,
  unit: "1",
  meaning: "",
  kind: "output",
});
const signals = [
  signal("sensor.displacement", "sensor", 0),
  signal("kalman.probability.healthy", "kalman", 1),
  signal("kalman.winner", "kalman.score", 2),
  signal("ideal.displacement", "ideal", 3),
  signal("two:kalman.winner", "kalman.score", 4),
  signal("drive.x.force", "drive.x", 5),
  signal("drive_loop.x", "drive_loop", 6),
  signal("pick_off.y.error", "pick_off.y", 7),
];
const instance = (id: string, family: string, name: string): Instance => ({
  id,
  title: "",
  family,
  name,
  path: id,
  also: [],
});

it("finds a diagnoser's with its score, not those of a twin", () =>
  expect(ownSignals(instance("diagnosers.kalman", "diagnose", "mmae"), signals).map((s) => s.name)).toEqual([
    "kalman.probability.healthy",
    "kalman.winner",
  ]));

it("finds a sensor's under its kind", () =>
  expect(ownSignals(instance("sensor", "sense", "ideal"), signals).map((s) => s.index)).toEqual([0, 3]));

it("finds those at each axis", () => {
  expect(ownSignals(instance("drive", "board", "axis_drive"), signals).map((s) => s.index)).toEqual([5]);
  expect(ownSignals(instance("sensor", "sense", "pick_off"), signals).map((s) => s.index)).toEqual([0, 7]);
});
