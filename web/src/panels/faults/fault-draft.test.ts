import { expect, it } from "vitest";
import type { BlockCard } from "../../api/types";
import { injectCommand, newDraft, ownParameters, refusals, scaled } from "./fault-draft";

it("injects a step now by default", () => {
  expect(injectCommand("added_mass", newDraft(0.05))).toEqual({
    kind: "inject",
    fault: "added_mass",
    severity: 0.05,
    profile: { kind: "step" },
  });
});

it("carries only what the chosen profile and moment need", () => {
  const draft = { ...newDraft(0.3), profile: "ramp" as const, moment: "at" as const, atMs: 40 };
  expect(injectCommand("damping", draft)).toEqual({
    kind: "inject",
    fault: "damping",
    severity: 0.3,
    profile: { kind: "ramp", duration_ms: 5 },
    at_ms: 40,
  });
  const blinking = { ...newDraft(0.3), profile: "intermittent" as const, moment: "when" as const };
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
  expect(refusals(blank)).toEqual({});
  expect(refusals({ ...blank, profile: "ramp" })).toEqual({ durationMs: "Say over how many ms" });
  expect(Object.keys(refusals({ ...blank, profile: "intermittent" }))).toEqual(["periodMs", "duty"]);
  expect(refusals({ ...blank, moment: "at" })).toEqual({ atMs: "Say at how many ms" });
  expect(refusals({ ...blank, severity: "", moment: "when", when: " " })).toEqual({
    severity: "Say how much",
    when: "Say on what condition",
  });
});

it("changes the unit of a number and leaves what is none", () => {
  expect(scaled(7, 0.01)).toBe(0.07);
  expect(scaled("-", 100)).toBe("-");
});
