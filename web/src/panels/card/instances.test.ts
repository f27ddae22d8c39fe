import { expect, it } from "vitest";
import type { Signal } from "../../api/types";
import { type Instance, instances, ownSignals, parameterValue } from "./instances";

const parameters = {
  plant: { model: "nonlinear" },
  diagnosers: { kalman: { kind: "mmae", probability_floor: 0 } },
  controllers: { mrac: { adaptation_gain: 3 } },
};

it("names each block on the bench and where its values are", () => {
  const list = instances({
    axes: [],
    slots: { "": "mrac" },
    parameters,
    controller: "mrac",
    controllers: ["open_loop", "mrac"],
    diagnosers: { kalman: { kind: "mmae", names: [], factors: [] } },
  });
  expect(list.find((i) => i.id === "plant")).toMatchObject({ family: "plant", name: "nonlinear", path: "plant" });
  expect(list.find((i) => i.id === "diagnosers.kalman")).toMatchObject({ family: "diagnose", name: "mmae" });
  expect(list.filter((i) => i.family === "control").map((i) => i.name)).toEqual(["mrac", "open_loop"]);
});

it("reads values where commands put them, shadow sensors and the active controller included", () => {
  const document = {
    controller: { kind: "mrac", leakage: 0.1 },
    controllers: { mrac: { adaptation_gain: 3 } },
    sensor: { kind: "ideal", noise_um: 0.05 },
    sensors: { ideal: { noise_um: 0.07 } },
  };
  const list = instances({
    axes: [],
    slots: { "": "mrac" },
    parameters: document,
    controller: "mrac",
    controllers: ["mrac"],
    diagnosers: {},
  });
  const value = (id: string, name: string) => {
    const instance = list.find((i) => i.id === id);
    return instance && parameterValue(document, instance, name);
  };
  expect(value("controllers.mrac", "adaptation_gain")).toBe(3);
  expect(value("controllers.mrac", "leakage")).toBe(0.1);
  expect(value("sensor", "noise_um")).toBe(0.07);
  expect(value("sensor", "range_um")).toBeUndefined();
});

it("has cards for identifiers, and none for the diagnosers of twins", () => {
  const list = instances({
    axes: [],
    slots: { "": "pid" },
    parameters: { identifiers: { excitation: { kind: "excitation" } } },
    controller: "pid",
    controllers: ["pid"],
    diagnosers: {
      kalman: { kind: "mmae", names: [], factors: [] },
      "two:kalman": { kind: "mmae", names: [], factors: [] },
    },
  });
  expect(list.find((i) => i.id === "identifiers.excitation")).toMatchObject({ family: "identify", name: "excitation" });
  expect(list.filter((i) => i.family === "diagnose").map((i) => i.id)).toEqual(["diagnosers.kalman"]);
});

it("has a rate, read-outs and a stage at each axis on a bench with axes, and no model", () => {
  const list = instances({
    axes: ["x", "y"],
    slots: { drive: "drive_loop", sense: "whole_angle" },
    parameters: { rate: { kind: "sine" }, readouts: { noise: { kind: "allan" } } },
    controller: "whole_angle",
    controllers: ["drive_loop", "forced_drive", "whole_angle"],
    diagnosers: {},
  });
  expect(list.map((i) => `${i.id} ${i.family} ${i.name}`)).toEqual([
    "rate rate sine",
    "waveform reference constant",
    "controllers.whole_angle control whole_angle",
    "controllers.drive_loop control drive_loop",
    "controllers.forced_drive control forced_drive",
    "environment board environment",
    "sampler board axis_sampler",
    "drive board axis_drive",
    "amplifier board axis_amplifier",
    "plant plant gyroscope",
    "sensor sense pick_off",
    "readouts.noise readout allan",
    "guard board axis_guard",
  ]);
});

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
