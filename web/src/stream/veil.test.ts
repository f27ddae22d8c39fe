import { afterEach, expect, it } from "vitest";
import { logEntry } from "./log-entry.fixture";
import { veil } from "./veil";

const event = (seq: number, kind: string) =>
  logEntry({ seq, tick: seq, kind, text: kind, old: null, new: null, actor: "board" });

afterEach(() => {
  veil.lift();
});

it("lets everything through until it drops", () => {
  const status = { faults: [{ name: "added_mass" }] as never[], pending: [] };
  expect(veil.status(status)).toBe(status);
  expect(veil.events([event(1, "inject")])).toHaveLength(1);
});

it("holds back what tells, and gives it back when lifted", () => {
  veil.show("a");
  veil.drop("a");
  expect(veil.status({ faults: [{}] as never[], pending: [{}] as never[] })).toEqual({ faults: [], pending: [] });
  const shown = veil.events([event(1, "inject"), event(2, "switch"), event(3, "recognised")]);
  expect(shown.map((e) => e.kind)).toEqual(["switch"]);
  expect(veil.lift().map((e) => e.seq)).toEqual([1, 3]);
  expect(veil.on).toBe(false);
});

it("lies over its own bench only, and is there again when that is shown again", () => {
  veil.show("a");
  veil.drop("a");
  veil.events([event(1, "inject")]);
  veil.show("b");
  expect(veil.on).toBe(false);
  expect(veil.events([event(1, "inject")])).toHaveLength(1);
  veil.show("a");
  expect(veil.events([event(1, "inject"), event(2, "switch")]).map((e) => e.seq)).toEqual([2]);
  expect(veil.lift().map((e) => e.seq)).toEqual([1]);
});
