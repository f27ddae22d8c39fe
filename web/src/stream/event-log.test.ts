import { expect, it } from "vitest";
import type { LogEntry } from "../api/types";
import { appendEvent } from "./event-log";
import { logEntry } from "./log-entry.fixture";

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
