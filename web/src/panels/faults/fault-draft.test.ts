import { expect, it } from "vitest";
import { injectCommand, newDraft } from "./fault-draft";

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
