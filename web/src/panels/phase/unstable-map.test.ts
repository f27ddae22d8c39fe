import { expect, it } from "vitest";
import type { UnstableRegion } from "../../api/types";
import { mapExtent, mapFits, mapWords } from "./unstable-map";

const slaved: UnstableRegion = {
  tick: 5,
  plant: "slaved_lateral",
  drive_v: 0,
  folds: [
    { x_um: 1.66, volts: -3.914, lateral_um: 0.7 },
    { x_um: -1.66, volts: 3.914, lateral_um: -0.7 },
  ],
  boundary: { x_um: [-3.7, 0, 3.7], speed_um_ms: [0, 53, 0] },
};

it("lies beneath travel and velocity only", () => {
  expect(mapFits("plant.displacement", "plant.velocity")).toEqual({ folds: true, boundary: true });
  expect(mapFits("plant.displacement", "drive.voltage")).toEqual({ folds: true, boundary: false });
  expect(mapFits("drive.voltage", "plant.velocity")).toEqual({ folds: false, boundary: false });
});

it("asks for room for the boundary, else for the folds", () => {
  expect(mapExtent(slaved, "x")?.[1]).toBeCloseTo(4.07);
  expect(mapExtent(slaved, "y")?.[0]).toBeCloseTo(-60.95);
  expect(mapExtent({ ...slaved, boundary: null }, "x")?.[1]).toBeCloseTo(1.909);
  expect(mapExtent({ ...slaved, boundary: null }, "y")).toBeUndefined();
  expect(mapExtent(undefined, "x")).toBeUndefined();
});

it("says what it shows", () => {
  expect(mapWords(slaved)).toMatch(/1\.66\u00a0µm and 3\.91\u00a0V.*Shaded/);
  expect(mapWords({ ...slaved, boundary: null })).toMatch(/held at 0\u00a0V nothing/);
  expect(mapWords({ ...slaved, plant: "linear", folds: [], boundary: null })).toBe("");
});
