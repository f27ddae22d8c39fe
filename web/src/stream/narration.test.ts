import { expect, it } from "vitest";
import type { Sentence } from "../api/types";
import { NOTHING_SAID, narrate } from "./narration";

const said = (tick: number): Sentence => ({
  tick,
  kind: "fault",
  text: `at ${tick}`,
  signals: [],
  span: [tick, tick],
  numbers: {},
});
const ticks = (of: { sentences: Sentence[] }) => of.sentences.map(({ tick }) => tick);

it("appends what comes behind what it has", () => {
  const first = narrate(NOTHING_SAID, { after: 0, sentences: [said(1), said(2)] });
  expect(ticks(narrate(first, { after: 2, sentences: [said(3)] }))).toEqual([1, 2, 3]);
});

it("drops what a jump has made void", () => {
  const first = narrate(NOTHING_SAID, { after: 0, sentences: [said(1), said(2), said(3)] });
  expect(ticks(narrate(first, { after: 1, sentences: [said(2)] }))).toEqual([1, 2]);
  expect(ticks(narrate(first, { after: 0, sentences: [] }))).toEqual([]);
});

it("begins where the server's memory begins", () => {
  const late = narrate(NOTHING_SAID, { after: 500, sentences: [said(9)] });
  expect(late.before).toBe(500);
  expect(ticks(narrate(late, { after: 501, sentences: [said(10)] }))).toEqual([9, 10]);
});

it("keeps no more than it can show, and counts the rest", () => {
  const many = Array.from({ length: 2100 }, (_, i) => said(i));
  const kept = narrate(NOTHING_SAID, { after: 0, sentences: many });
  expect([kept.before, kept.sentences.length, kept.sentences[0].tick]).toEqual([100, 2000, 100]);
});
