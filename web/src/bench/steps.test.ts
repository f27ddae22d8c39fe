import { expect, it, vi } from "vitest";
import type { Bench, LogEntry } from "../api/types";
import { stepsOf } from "./steps";

vi.mock("../api/use-catalog", () => ({ cardOf: () => undefined }));

const mass = { fault: "added_mass", severity: 0.05 };
const stiffness = { fault: "stiffness", severity: 0.1 };
const event = (kind: string, tick: number, actor: string, command?: object) =>
  ({ seq: 1, kind, tick, actor, text: "", command }) as unknown as LogEntry;
const waits = (actor: string, command: object, tick: number | null, when: string | null = null) =>
  ({ text: "", actor, tick, when, command }) as unknown as Bench["pending"][number];

it("counts what the bench begins with, what was done and what waits; one moment is one step", () => {
  const steps = stepsOf(
    [event("heal", 0, "scenario", { heal: "all" }), event("inject", 2000, "scenario", mass)],
    [waits("scenario", { heal: ["added_mass"] }, 3000), waits("scenario", stiffness, 3000)],
  );
  expect(steps.map(({ words, tick, done }) => [words.replace(/\u00a0/g, " "), tick, done])).toEqual([
    ["start", 0, true],
    ["added mass", 2000, true],
    ["added mass removed, stiffness", 3000, false],
  ]);
});

it("has what a person let wait, before and after its moment, but nothing done at once", () => {
  const now = event("inject", 10, "page", stiffness);
  const asked = event("scheduled", 20, "page", { ...mass, at_sample: 50 });
  const first = stepsOf([now, asked], [waits("page", { ...mass, at_sample: 50 }, 50)]);
  expect(first.map((s) => s.done)).toEqual([true, false]);
  const own = waits("page", stiffness, null, "plant.displacement > 2");
  const later = stepsOf([now, asked, event("inject", 50, "page", mass)], [own]);
  expect(later.map((s) => [s.tick, s.when, s.ofScenario])).toEqual([
    [0, undefined, true],
    [50, undefined, false],
    [undefined, "plant.displacement > 2", false],
  ]);
});

it("is empty where nothing waits and nothing of a scenario was done", () => {
  expect(stepsOf([event("inject", 10, "page", mass)], [])).toEqual([]);
});
