import { expect, test } from "vitest";
import type { Tile } from "../api/types";
import { arranged, isRight, outcomeLine, outline } from "./members";

const tile = (name: string, more: Partial<Tile> = {}): Tile => ({
  id: name,
  name,
  hand: false,
  bench: name,
  watchers: 1,
  until: null,
  ...more,
});
const CLASS = [tile("Emmy"), tile("Ada"), tile("Grace", { hand: true }), tile("Lise", { state: "tripped" })];
const names = (tiles: Tile[]) => tiles.map(({ name }) => name);

test("students come by name, or those first who need something, and as far as their name has the letters", () => {
  expect(names(arranged(CLASS, "name", ""))).toEqual(["Ada", "Emmy", "Grace", "Lise"]);
  expect(names(arranged(CLASS, "hand", ""))).toEqual(["Grace", "Ada", "Emmy", "Lise"]);
  expect(names(arranged(CLASS, "tripped", ""))).toEqual(["Lise", "Ada", "Emmy", "Grace"]);
  expect(names(arranged([tile("Table 10"), tile("Table 9")], "name", ""))).toEqual(["Table 9", "Table 10"]);
  expect(names(arranged(CLASS, "hand", " E"))).toEqual(["Grace", "Emmy", "Lise"]);
});

test("a verdict is right, wrong, or not there yet", () => {
  const verdict = (says: string | null, truth: string | null) => ({
    diagnoser: "kalman",
    says,
    truth,
    correct_fraction: 1,
    factors: {},
  });
  expect(isRight(verdict("m+5", "m+5"))).toBe(true);
  expect(isRight(verdict("healthy", "m+5"))).toBe(false);
  expect(isRight(verdict("healthy", null))).toBe(false);
  expect(isRight(verdict(null, "m+5"))).toBeUndefined();
  expect(isRight(verdict(null, null))).toBe(true);
});

test("what came of something done on many benches is one line, with the first of those that refused", () => {
  expect(outcomeLine("Freeze", { done: 28, failed: [] })).toBe("Freeze: 28 done.");
  expect(outcomeLine("Release", { done: 26, failed: ["Ada: it has tripped", "Lise: it has tripped"] })).toBe(
    "Release: 26 done, 2 refused: Ada: it has tripped; Lise: it has tripped.",
  );
  expect(outcomeLine("Release", { done: 0, failed: ["a: x", "b: x", "c: x", "d: x", "e: x"] })).toBe(
    "Release: 0 done, 5 refused: a: x; b: x; c: x; and 2 more.",
  );
});

test("a small trace fills its box, unless it is smaller than the least that is motion", () => {
  expect(outline([], 0.5)).toEqual({ path: "", reach: 0.5 });
  const trace: [number, number][] = [
    [-2, -1],
    [0, 1],
  ];
  expect(outline(trace, 0.5)).toEqual({ path: "M0 1.5L1 0.5L1 1L0 2Z", reach: 2 });
  expect(outline(trace, 4).reach).toBe(4);
});
