import { expect, it } from "vitest";
import { currentEvents } from "./current-events";
import { logEntry } from "./log-entry.fixture";

it("forgets what a reset or a restore has undone", () => {
  const log = [
    logEntry({ seq: 1, tick: 100, kind: "inject" }),
    logEntry({ seq: 2, tick: 0, kind: "reset" }),
    logEntry({ seq: 3, tick: 50, kind: "inject" }),
    logEntry({ seq: 4, tick: 200, kind: "heal" }),
    logEntry({ seq: 5, tick: 120, kind: "restored" }),
  ];
  expect(currentEvents(log).map((e) => e.seq)).toEqual([2, 3, 5]);
});
