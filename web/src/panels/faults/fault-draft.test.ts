import { expect, it } from "vitest";
import type { BlockCard } from "../../api/types";
import { type FaultDraft, groupsOf, injectCommand, newDraft, ownParameters, refusals, scaled } from "./fault-draft";

const scale = { percent: true, low: -0.5, high: 0.5, minimum: -0.95, maximum: 20, step: 1 };

it("injects a step now by default", () => {
  expect(injectCommand("added_mass", newDraft(0.05))).toEqual({
    fault: "added_mass",
    severity: 0.05,
    profile: { kind: "step" },
  });
});

it("carries only what the chosen profile and moment need", () => {
  const draft = { ...newDraft(0.3), profile: "ramp" as const, moment: "at" as const, atMs: 40 };
  expect(injectCommand("damping", draft)).toEqual({
    fault: "damping",
    severity: 0.3,
    profile: { kind: "ramp", duration_ms: 5 },
    at_ms: 40,
  });
  const when = { signal: "plant.displacement", above: true, level: 2 };
  const blinking = { ...newDraft(0.3), profile: "intermittent" as const, moment: "when" as const, when };
  expect(injectCommand("damping", blinking)).toMatchObject({
    profile: { kind: "intermittent", period_ms: 2, duty: 0.5 },
    when: "plant.displacement > 2",
  });
});

it("says where and on which part, as far as that was chosen", () => {
  const fault = { parameters: [{ name: "severity" }, { name: "profile" }, { name: "start_tick" }, { name: "beam" }] };
  expect(ownParameters(fault as unknown as BlockCard).map((p) => p.name)).toEqual(["beam"]);
  const draft = { ...newDraft(1), parameters: { beam: "outer", position: 0.4 } };
  expect(injectCommand("point_adhesion", draft)).toMatchObject({ parameters: { beam: "outer", position: 0.4 } });
});

it("refuses a blank or a wrong number in words, where it is used", () => {
  const blank = { ...newDraft(0.05), durationMs: "", periodMs: 0, duty: "", atMs: "-" };
  const refused = (draft: FaultDraft) => refusals(draft, scale, "1");
  expect(refused(blank)).toEqual({});
  expect(refused({ ...blank, profile: "ramp" })).toEqual({ durationMs: "Say over how many ms" });
  expect(Object.keys(refused({ ...blank, profile: "intermittent" }))).toEqual(["periodMs", "duty"]);
  expect(refused({ ...blank, moment: "at" })).toEqual({ atMs: "Say at how many ms" });
  const when = { signal: "plant.displacement", above: true, level: "" };
  expect(refused({ ...blank, severity: "", moment: "when", when })).toEqual({
    severity: "Say how much",
    when: "Say at what value",
  });
  expect(refused({ ...blank, severity: 21 })).toEqual({ severity: "At most +2000\u00a0%" });
  expect(refused({ ...blank, severity: -0.96 })).toEqual({ severity: "At least −95\u00a0%" });
});

it("changes the unit of a number and leaves what is none", () => {
  expect(scaled(7, 0.01)).toBe(0.07);
  expect(scaled("-", 100)).toBe("-");
});

it("shows on slider and box the number that is sent, whatever the step", () => {
  const wrong: number[] = [];
  for (let tenths = -950; tenths <= 20_000; tenths += 7) {
    const entry = tenths / 10;
    const sent = Number(scaled(entry, 0.01));
    if (scaled(sent, 100) !== entry || String(sent).length > 7) wrong.push(entry);
  }
  expect(wrong).toEqual([]);
});

it("keeps the order of the catalogue, and those without a group under a heading of theirs", () => {
  const fault = (name: string, group: string) => ({ name, group });
  const found = groupsOf([
    fault("mass", "The usual"),
    fault("noise", "Measurement"),
    fault("k", "The usual"),
    fault("mine", ""),
  ]);
  expect(found.map(([group, members]) => [group, ...members.map((f) => f.name)])).toEqual([
    ["The usual", "mass", "k"],
    ["Measurement", "noise"],
    ["Others", "mine"],
  ]);
});
