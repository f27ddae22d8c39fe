import { expect, it, vi } from "vitest";
import type { LogEntry } from "../api/types";
import { flagWords } from "./flag-words";

vi.mock("../api/use-catalog", () => ({
  cardOf: (_: string, name: string) =>
    ({
      added_mass: { title: "Added mass", suggested: 0.05, parameters: [{ name: "severity", unit: "1" }] },
      vsc: { title: "Variable structure", parameters: [] },
    })[name],
}));

const words = (event: object) => flagWords({ seq: 1, tick: 0, actor: "a", text: "", ...event } as unknown as LogEntry);

it("says a fault with its severity", () => {
  expect(words({ kind: "inject", command: { fault: "added_mass", severity: 0.05 } })).toBe("Added mass +5\u00a0%");
  expect(words({ kind: "inject", command: { fault: "not_known_yet", severity: -0.5 } })).toBe("not known yet");
});

it("says what else was done and found", () => {
  expect(words({ kind: "switch", command: { switch: "vsc", cold: false } })).toBe("Variable structure");
  expect(words({ kind: "set", command: { set: { "controllers.pid.pole": 1 } } })).toBe("pole changed");
  expect(words({ kind: "set", command: { set: { "rate.deg_per_s": 100 } } })).toBe("angular rate 100\u00a0deg/s");
  expect(words({ kind: "heal", command: { heal: "all" } })).toBe("healed");
  expect(words({ kind: "recognised", new: "m+5" })).toBe("found mass +5\u00a0%");
  expect(words({ kind: "tripped" })).toBe("stopped");
  expect(words({ kind: "restored" })).toBe("restored");
});
