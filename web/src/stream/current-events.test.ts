import { expect, it } from "vitest";
import { currentEvents } from "./current-events";
import { logEntry } from "./log-entry.fixture";

const seqs = (log: Parameters<typeof currentEvents>[0]) => currentEvents(log).map((e) => e.seq);

const LOG = [
  logEntry({ seq: 1, tick: 100, kind: "inject" }),
  logEntry({ seq: 2, tick: 0, kind: "reset" }),
  logEntry({ seq: 3, tick: 50, kind: "inject" }),
  logEntry({ seq: 4, tick: 200, kind: "heal" }),
];

it("forgets what a reset or a restore has undone", () => {
  expect(seqs(LOG)).toEqual([2, 3, 4]);
  expect(seqs([...LOG, logEntry({ seq: 5, tick: 120, kind: "restored", new: 3 })])).toEqual([2, 3, 5]);
});

it("knows again what led to a moment once the reset after it is undone", () => {
  expect(seqs([...LOG, logEntry({ seq: 5, tick: 150, kind: "restored", new: 1 })])).toEqual([1, 5]);
});

it("goes by ticks where an earlier version did not say which event was the last", () => {
  expect(seqs([...LOG, logEntry({ seq: 5, tick: 120, kind: "restored", new: null })])).toEqual([2, 3, 5]);
});

it("is quick after many returns", () => {
  const jumps = Array.from({ length: 200 }, (_, i) => logEntry({ seq: 5 + i, tick: 60, kind: "restored", new: 4 + i }));
  expect(currentEvents([...LOG, ...jumps])).toHaveLength(203);
});
