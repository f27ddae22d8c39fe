import { act } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import type { LogEntry } from "../api/types";
import { connect, type FakeTransport } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { jump } from "../ui/hover";
import { useAnnouncements } from "./announce";
import { dismissChange, lastChange, makeSlide, REST_MS, useChange } from "./change";

const { bench, events: old } = await recordedBench("first-look");

const event = (seq: number, tick: number, kind: string, rest: Partial<LogEntry> = {}): LogEntry => ({
  seq,
  tick,
  kind,
  actor: "page",
  text: kind,
  command: null,
  old: null,
  new: null,
  at: "2026-01-01T00:00:00Z",
  ...rest,
});
const switched = (seq: number, tick: number) => event(seq, tick, "switch", { command: { switch: "mrac" } as never });
const set = (seq: number, tick: number, value: number, at: string) =>
  event(seq, tick, "set", { command: { set: { "reference.amplitude_v": value } } as never, at });
const shown = () => useChange.getState().change;
const pass = (ms: number) => act(() => vi.advanceTimersByTimeAsync(ms));

let board: FakeTransport;
beforeEach(() => {
  vi.useFakeTimers();
  board = connect(bench);
});

async function happen(...events: LogEntry[]): Promise<void> {
  board.say({ type: "events", events } as never);
  await pass(30);
}

it("does not compare changes from before the page came, and compares the next", async () => {
  await happen(...old);
  expect(shown()).toBeUndefined();
  await happen(switched(20, bench.tick));
  expect(shown()).toMatchObject({ tick: 2000, since: 2000 });
});

it("takes the changes of one tick as one, and a healing of nothing as none", () => {
  const healed = event(1, 50, "heal", { old: { added_mass: {} } });
  const injected = event(2, 50, "inject");
  const idle = event(3, 60, "heal", { old: {} });
  expect(lastChange([healed, injected, idle], 0, 100)?.events).toEqual([healed, injected]);
  expect(lastChange([event(1, 0, "inject")], 0, 100)).toBeUndefined();
});

it("waits until a slider rests, and compares with the time before it moved", async () => {
  await happen(set(20, 2000, 9, "2026-01-01T00:00:00.0Z"));
  await pass(REST_MS - 100);
  board.status({ tick: 2200 });
  await happen(set(21, 2200, 8, "2026-01-01T00:00:00.9Z"));
  await pass(REST_MS - 100);
  expect(shown()).toBeUndefined();
  await pass(100);
  expect(shown()).toMatchObject({ tick: 2000, since: 2200 });
  expect(shown()?.events.map(({ seq }) => seq)).toEqual([20, 21]);
});

it("takes two moves of a slider with a rest between them as two", () => {
  const moves = [set(1, 50, 9, "2026-01-01T00:00:00Z"), set(2, 90, 8, "2026-01-01T00:00:03Z")];
  expect(lastChange(moves, 0, 100)).toMatchObject({ tick: 90, since: 90 });
});

it("stays until it is dismissed, and the next change comes in its place", async () => {
  await happen(switched(20, 2000));
  board.status({ tick: 50_000 });
  expect(shown()?.tick).toBe(2000);
  act(dismissChange);
  board.status({ tick: 50_100 });
  expect(shown()).toBeUndefined();
  await happen(switched(21, 50_100));
  expect(shown()?.tick).toBe(50_100);
});

it.each([
  ["a scope looks at a moment before it", () => act(() => jump.to({ tick: 1999 }))],
  ["the bench goes back to a moment before it", () => board.status({ tick: 1900 })],
  ["the bench is reset", () => board.status({ tick: 0 })],
  ["another bench is opened", () => board.hello({ ...bench, id: "other", tick: 3000 })],
])("goes when %s", async (_, seek) => {
  await happen(switched(20, 2000));
  board.status({ tick: 2500 });
  expect(shown()).toBeDefined();
  seek();
  expect(shown()).toBeUndefined();
});

it("stays while scopes look at a moment after it", async () => {
  await happen(switched(20, 2000));
  act(() => jump.to({ tick: 2000 }));
  act(() => jump.to("live"));
  expect(shown()?.tick).toBe(2000);
});

it("says that there is no slide where nothing has changed", () => {
  act(makeSlide);
  expect(useAnnouncements.getState().polite).toBe("There is nothing to compare: nothing has changed.");
});
