import { expect, it } from "vitest";
import { queryClient } from "../../api/queries";
import type { LogEntry } from "../../api/types";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { changeWords, ratioWords } from "./change-words";

const { bench } = await recordedBench("first-look");
const { blocks } = await recordedAnswer("catalog");

const say = (...events: Partial<LogEntry>[]) => {
  queryClient.setQueryData(["catalog"], blocks);
  return changeWords({ events: events as LogEntry[], tick: 1, since: 1 }, bench).replaceAll(/\s/g, " ");
};

it("says a fault, a healing, a switch and a parameter in the words of their cards", () => {
  const healed: Partial<LogEntry> = { kind: "heal", command: { heal: "all" } as never, old: { damping: {} } };
  const injected: Partial<LogEntry> = { kind: "inject", command: { fault: "added_mass", severity: 0.05 } as never };
  expect(say(injected)).toBe("Added mass +5 %");
  expect(say(healed)).toBe("Damping healed");
  expect(say({ ...healed, old: { damping: {}, added_mass: {} } })).toBe("All faults healed");
  expect(say(healed, injected)).toBe("Damping healed, Added mass +5 %");
  expect(say({ kind: "switch", command: { switch: "mrac" } as never })).toBe("Switch to Direct MRAC");
});

it("says a slider from the value before it moved to the value at which it rests", () => {
  const path = "reference.amplitude_v";
  const first: Partial<LogEntry> = { kind: "set", old: { [path]: 10 }, new: { [path]: 9 } };
  const last: Partial<LogEntry> = { kind: "set", old: { [path]: 9 }, new: { [path]: 5 } };
  expect(say(first, last)).toBe("Reference: amplitude 10 V → 5 V");
});

it("says another sensor by its two names", () => {
  const path = "sensor.kind";
  const event: Partial<LogEntry> = { kind: "set", old: { [path]: "ideal" }, new: { [path]: "capacitive" } };
  expect(say(event)).toBe("Sensor: ideal → capacitive");
});

it.each([
  [218, 16.4, "13 times smaller"],
  [1, 2.5, "2.5 times larger"],
  [1, 1.08, "8.0 % larger"],
  [1, 0.65, "35.0 % smaller"],
  [1, 1.001, "unchanged"],
  [0.0163, 100, "over 1000 times larger"],
  [0, 1, ""],
  [Number.NaN, 1, ""],
])("says that %d and then %d is %s", (before, after, words) => {
  expect(ratioWords(before, after).replaceAll(/\s/g, " ")).toBe(words);
});
