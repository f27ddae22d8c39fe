import { expect, it } from "vitest";
import type { LogEntry } from "../api/types";
import { setUnits } from "../api/use-catalog";
import { hintsOf } from "./hints";

const signals = [
  { name: "plant.displacement", unit: "um", meaning: "", block: "plant", kind: "output" as const, index: 0 },
];
const bench = { axes: [] as string[], controllers: ["open_loop"], diagnosers: {}, replay_of: null, signals };
const FACTORS: Record<string, number>[] = [{}, { mass: 1.05 }, { stiffness: 1.05 }];
const full = {
  ...bench,
  controllers: ["open_loop", "mrac"],
  diagnosers: {
    kalman: { kind: "mmae", names: ["healthy", "m+5", "k+5"], factors: FACTORS },
  },
};
const ids = (made: ReturnType<typeof hintsOf>) => made?.hints.map((hint) => hint.id);

it("mentions Diagnosis only where there is a diagnoser, and controllers where there are others", () => {
  expect(ids(hintsOf(bench))).toEqual(["mass"]);
  expect(ids(hintsOf(full))).toEqual(["mass", "find", "switch"]);
  expect(hintsOf(full)?.intro).toMatch(/resonator/);
  expect(hintsOf(full)?.more).toMatch(/lane/);
  expect(hintsOf(bench)?.more).toBe("");
});

it("suits what is open: the rate of a gyroscope, nothing on a recording", () => {
  const gyroscope = { ...full, axes: ["x", "y"] };
  expect(ids(hintsOf(gyroscope))).toEqual(["rate", "switch"]);
  expect(hintsOf(gyroscope)?.intro).toMatch(/gyroscope/);
  expect(hintsOf(gyroscope)?.guided.scenario).toBe("gyro-diagnosis");
  expect(hintsOf(full)?.guided.scenario).toBe("ch5-seven-step");
  expect(hintsOf({ ...bench, replay_of: "x" })).toBeUndefined();
});

it("counts as done what a person does, not what the scenario does", () => {
  const [mass] = hintsOf(full)?.hints ?? [];
  const command = { fault: "added_mass", severity: 0.05 };
  const inject = (actor: string) => ({ kind: "inject", actor, command }) as LogEntry;
  expect([mass.isDone(inject("page")), mass.isDone(inject("scenario"))]).toEqual([true, false]);
  const [rate] = hintsOf({ ...full, axes: ["x", "y"] })?.hints ?? [];
  const set = { kind: "set", actor: "page", command: { set: { "rate.deg_per_s": 10 } } } as unknown as LogEntry;
  expect(rate.isDone(set)).toBe(true);
});

it("counts as done no other fault, finding or controller than the hint names", () => {
  const [mass, find] = hintsOf(full)?.hints ?? [];
  const inject = (fault: string, severity = 0.05) =>
    ({ kind: "inject", actor: "page", command: { fault, severity } }) as unknown as LogEntry;
  expect([inject("added_mass"), inject("stiffness"), inject("added_mass", 0)].map(mass.isDone)).toEqual([
    true,
    false,
    false,
  ]);
  const recognised = (label: string) => ({ kind: "recognised", actor: "board", new: label }) as LogEntry;
  expect(["m+5", "k+5", "healthy"].map((label) => find.isDone(recognised(label)))).toEqual([true, false, false]);
  const law = (name: string, slot: string) => ({ family: "control", name, slot });
  setUnits([law("rebalance", "sense"), law("loop", "drive")] as never);
  const hints = hintsOf({ ...full, axes: ["x", "y"] })?.hints ?? [];
  const change = (to: string) => ({ kind: "switch", actor: "page", command: { switch: to } }) as unknown as LogEntry;
  expect(["rebalance", "loop"].map((to) => hints[1].isDone(change(to)))).toEqual([true, false]);
});
