import { expect, it } from "vitest";
import { instances, valueAt } from "./instances";

const parameters = {
  plant: { model: "nonlinear" },
  diagnosers: { kalman: { kind: "mmae", probability_floor: 0 } },
  controllers: { mrac: { adaptation_gain: 3 } },
};

it("names each block on the bench and where its values are", () => {
  const list = instances({
    parameters,
    controller: "mrac",
    controllers: ["open_loop", "mrac"],
    diagnosers: { kalman: { kind: "mmae", names: [] } },
  });
  expect(list.find((i) => i.id === "plant")).toMatchObject({ family: "plant", name: "nonlinear", path: "plant" });
  expect(list.find((i) => i.id === "diagnosers.kalman")).toMatchObject({ family: "diagnose", name: "mmae" });
  expect(list.filter((i) => i.family === "control").map((i) => i.name)).toEqual(["mrac", "open_loop"]);
});

it("reads values by the path that commands use", () => {
  expect(valueAt(parameters, "controllers.mrac.adaptation_gain")).toBe(3);
  expect(valueAt(parameters, "diagnosers.kalman.probability_floor")).toBe(0);
  expect(valueAt(parameters, "sensor.noise_um")).toBeUndefined();
});
