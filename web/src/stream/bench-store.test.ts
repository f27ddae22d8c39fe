import { expect, it } from "vitest";
import type { Bench } from "../api/types";
import { mergeStatus } from "./bench-store";

const bench = {
  id: "b1",
  state: "running",
  tick: 5,
  faults: [{ name: "added_mass", severity: 0.05, profile: { kind: "step" }, since_tick: 3 }],
  parameters: { a: { b: 1 } },
} as unknown as Bench;

it("takes what changed and keeps the identity of what did not", () => {
  const next = mergeStatus(bench, {
    tick: 6,
    faults: [{ name: "added_mass", severity: 0.05, profile: { kind: "step" }, since_tick: 3 }],
  });
  expect(next.tick).toBe(6);
  expect(next.faults).toBe(bench.faults);
  expect(next.parameters).toBe(bench.parameters);
});

it("returns the same bench when nothing changed", () => {
  expect(mergeStatus(bench, { tick: 5, state: "running" })).toBe(bench);
});

it("keeps the parameters when a status leaves them out", () => {
  expect(mergeStatus(bench, { tick: 7, parameters: null } as unknown as Partial<Bench>).parameters).toBe(
    bench.parameters,
  );
});

it("learns of a trip and of its end, and ignores the message's own fields", () => {
  const trip = { tick: 9, time_ms: 0.18, reason: "rail", signal: "drive.voltage", value: 40 };
  const tripped = mergeStatus(bench, { trip, state: "tripped", type: "status" } as unknown as Partial<Bench>);
  expect(tripped.trip).toEqual(trip);
  expect("type" in tripped).toBe(false);
  expect(mergeStatus(tripped, { trip: null }).trip).toBeNull();
});
