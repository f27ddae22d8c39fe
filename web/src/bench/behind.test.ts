// @vitest-environment jsdom
import { expect, it } from "vitest";
import type { Bench } from "../api/types";
import { type Behind, behindOf } from "./behind";

const bench = (id: string, origin?: string, dt_ms = 0.01) =>
  ({
    id,
    title: `title of ${id}`,
    name: "",
    dt_ms,
    origin: origin ? { bench: origin, is_past: false } : null,
  }) as Bench;
const behind = (id: string, shift = 0): Behind => ({ bench: id, words: id, shift });
const ids = (all: Behind[]) => all.map((one) => `${one.bench} ${one.shift}`);

it("changes places with a bench that was behind", () => {
  const found = behindOf([behind("b", 5), behind("c", 7)], bench("a"), bench("b"));
  expect(ids(found)).toEqual(["a -5", "c 2"]);
  expect(found[0].words).toBe("title of a");
});

it("keeps what is behind a bench and its branches", () => {
  expect(ids(behindOf([behind("c")], bench("a"), bench("b", "a")))).toEqual(["c 0"]);
  expect(ids(behindOf([behind("c")], bench("b", "a"), bench("a")))).toEqual(["c 0"]);
});

it("forgets it with another bench", () => {
  expect(behindOf([behind("c")], bench("a"), bench("d"))).toEqual([]);
  expect(behindOf([behind("d")], bench("a"), bench("d", undefined, 0.02))).toEqual([]);
  expect(behindOf([], undefined, bench("d"))).toEqual([]);
});
