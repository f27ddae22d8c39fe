import { expect, it } from "vitest";
import type { LogEntry } from "../api/types";
import { drivenBy } from "./driven";

const switched = (tick: number, old: string, name: string) =>
  ({ kind: "switch", tick, old, new: name }) as unknown as LogEntry;

it("follows the switches of a slot back to the controller that drove first", () => {
  const events = [
    switched(100, "open", "rebalance"),
    switched(150, "agc", "pll"),
    { kind: "inject", tick: 170 } as LogEntry,
    switched(200, "rebalance", "whole_angle"),
  ];
  expect(drivenBy("whole_angle", events)).toEqual([
    { name: "whole_angle", from: 200, until: Number.POSITIVE_INFINITY },
    { name: "rebalance", from: 100, until: 200 },
    { name: "open", from: 0, until: 100 },
  ]);
});

it("knows one controller where nothing was switched", () => {
  expect(drivenBy("open", [])).toEqual([{ name: "open", from: 0, until: Number.POSITIVE_INFINITY }]);
});
