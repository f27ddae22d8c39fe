import { expect, it } from "vitest";
import type { ActiveFault, LogEntry } from "../api/types";
import { logEntry } from "../testing/log-entry";
import { faultSpans } from "./marks";

let seq = 0;
const entry = (tick: number, kind: string, command: LogEntry["command"]) =>
  logEntry({ seq: ++seq, tick, kind, command });
const inject = (tick: number, fault: string, severity = 0.05) => entry(tick, "inject", { fault, severity });

it("runs from injection to healing, several at once", () => {
  const spans = faultSpans([
    inject(10, "added_mass"),
    inject(20, "damping", 0.3),
    entry(30, "heal", { heal: ["added_mass"] }),
  ]);
  expect(spans).toEqual([
    { name: "added_mass", severity: 0.05, start: 10, end: 30 },
    { name: "damping", severity: 0.3, start: 20, end: undefined },
  ]);
});

it("ends a fault that is injected again, and all of them on heal all", () => {
  const spans = faultSpans([
    inject(10, "added_mass"),
    inject(20, "added_mass", 0.1),
    entry(40, "heal", { heal: "all" }),
  ]);
  expect(spans.map((s) => [s.severity, s.start, s.end])).toEqual([
    [0.05, 10, 20],
    [0.1, 20, 40],
  ]);
});

it("does not take a scheduled fault for one that acts", () => {
  expect(faultSpans([entry(5, "scheduled", { fault: "added_mass", severity: 0.05 })])).toEqual([]);
});

it("ends at a severity of 0, and where the board says that it acts no more although no healing was heard", () => {
  expect(faultSpans([inject(10, "added_mass"), inject(30, "added_mass", 0)])).toMatchObject([{ start: 10, end: 30 }]);
  const missed = [inject(10, "added_mass"), inject(20, "damping")];
  const damping = { name: "damping", severity: 0.05, since_tick: 20 } as ActiveFault;
  expect(faultSpans(missed, [damping], 400)).toMatchObject([
    { name: "added_mass", start: 10, end: 400 },
    { name: "damping", start: 20, end: undefined },
  ]);
  expect(faultSpans([inject(10, "added_mass")], [], 5)).toMatchObject([{ end: undefined }]);
});
