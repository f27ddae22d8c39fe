import { expect, it } from "vitest";
import type { LogEntry } from "../api/types";
import { hintsOf } from "./hints";

const signals = [
  { name: "plant.displacement", unit: "um", meaning: "", block: "plant", kind: "output" as const, index: 0 },
];
const bench = { axes: [] as string[], controllers: ["open_loop"], diagnosers: {}, replay_of: null, signals };
const full = {
  ...bench,
  controllers: ["open_loop", "mrac"],
  diagnosers: { kalman: { kind: "mmae", names: [], factors: [] } },
};
const ids = (made: ReturnType<typeof hintsOf>) => made?.hints.map((hint) => hint.id);

it("mentions Diagnosis only where there is a diagnoser, and controllers where there are others", () => {
  expect(ids(hintsOf(bench, false))).toEqual(["mass"]);
  expect(ids(hintsOf(full, false))).toEqual(["mass", "find", "switch"]);
  expect(hintsOf(full, false)?.intro).toMatch(/resonator.*lane/);
});

it("suits what is open: the rate of a gyroscope, the steps of a scenario, nothing on a recording", () => {
  const gyroscope = { ...full, axes: ["x", "y"] };
  expect(ids(hintsOf(gyroscope, false))).toEqual(["rate", "switch"]);
  expect(hintsOf(gyroscope, false)?.intro).toMatch(/gyroscope/);
  expect(ids(hintsOf(full, true))).toEqual(["find", "skip"]);
  expect(ids(hintsOf({ ...gyroscope, diagnosers: {} }, true))).toEqual(["rate", "switch", "skip"]);
  expect(hintsOf(full, true)?.guided).toBeUndefined();
  expect(hintsOf({ ...bench, replay_of: "x" }, false)).toBeUndefined();
});

it("counts as done what a person does, not what the scenario does", () => {
  const [mass] = hintsOf(full, false)?.hints ?? [];
  const inject = (actor: string) => ({ kind: "inject", actor }) as LogEntry;
  expect([mass.isDone(inject("page")), mass.isDone(inject("scenario"))]).toEqual([true, false]);
  const [rate] = hintsOf({ ...full, axes: ["x", "y"] }, false)?.hints ?? [];
  const set = { kind: "set", actor: "page", command: { set: { "rate.deg_per_s": 10 } } } as unknown as LogEntry;
  expect(rate.isDone(set)).toBe(true);
});
