import { expect, it } from "vitest";
import { tryThis } from "./try-this";

const signals = [
  { name: "plant.displacement", unit: "um", meaning: "", block: "plant", kind: "output" as const, index: 0 },
];
const bench = { axes: [] as string[], controllers: ["open_loop"], diagnosers: {}, replay_of: null, signals };

it("mentions Diagnosis only where there is a diagnoser, and controllers where there are others", () => {
  expect(tryThis(bench)).not.toMatch(/Diagnosis|controller/);
  const full = { ...bench, controllers: ["open_loop", "mrac"], diagnosers: { kalman: { kind: "mmae", names: [] } } };
  expect(tryThis(full)).toMatch(/Diagnosis find it.*controller/);
});

it("speaks of the rate on a bench with axes", () => {
  expect(tryThis({ ...bench, axes: ["x", "y"] })).toMatch(/angular rate/);
});

it("says nothing on a bench that plays a recording", () => {
  expect(tryThis({ ...bench, replay_of: "x" })).toBeUndefined();
});
