import { expect, it } from "vitest";
import type { LogEntry } from "../api/types";
import { logEntry } from "../testing/log-entry";
import { appendEvent, currentEvents } from "./event-log";

const entry = (seq: number) => logEntry({ seq, tick: seq * 10 });

it("appends in order and ignores what a replay repeats", () => {
  let log: LogEntry[] = [];
  for (const seq of [1, 2, 2, 1, 3]) log = appendEvent(log, entry(seq));
  expect(log.map((e) => e.seq)).toEqual([1, 2, 3]);
});

it("fills a gap from a replay that arrives late", () => {
  let log: LogEntry[] = [];
  for (const seq of [1, 4, 2, 3]) log = appendEvent(log, entry(seq));
  expect(log.map((e) => e.seq)).toEqual([1, 2, 3, 4]);
});

it("returns the same array when nothing changes, so nothing re-renders", () => {
  const log = [entry(1)];
  expect(appendEvent(log, entry(1))).toBe(log);
});

it("stays bounded", () => {
  let log: LogEntry[] = [];
  for (let seq = 1; seq <= 2100; seq += 1) log = appendEvent(log, entry(seq));
  expect(log.length).toBe(2000);
  expect(log[0].seq).toBe(101);
});

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
