// @vitest-environment jsdom
import { expect, it } from "vitest";
import { RecordingPen } from "../testing/recording-pen";
import { TRACE_COLOURS } from "../ui/palette";
import { paintRanks } from "./paint-ranks";

const BOX = { width: 500, height: 130 };
const LOOK = { scheme: "dark", fontSize: 12 } as const;
const BAR = TRACE_COLOURS.dark[1];

it("draws correlations as bars from zero, the first on top, before what chance would give", () => {
  const pen = new RecordingPen();
  const ranks = [
    { name: "noise", value: 0.8 },
    { name: "mass", value: -0.4 },
    { name: "pressure", value: 0.05 },
  ];
  const { x } = paintRanks(pen, BOX, { label: "rank correlation", span: [-1, 1], ranks, chance: 0.2 }, LOOK);
  const names = pen.texts.filter(({ text }) => ranks.some(({ name }) => name === text));
  expect([...names].sort((a, b) => a.points[0][1] - b.points[0][1]).map(({ text }) => text)).toEqual(
    ranks.map(({ name }) => name),
  );
  const bars = pen.rects(BAR);
  expect(bars.map(({ left, right }) => [left, right].map(Math.round))).toEqual(
    ranks.map(({ value }) => [Math.min(0, value), Math.max(0, value)].map((at) => Math.round(x(at)))),
  );
  expect(bars[0].top).toBeLessThan(bars[1].top);
  expect(pen.rects().some(({ left, right }) => Math.abs(left - x(-0.2)) < 1 && Math.abs(right - x(0.2)) < 1)).toBe(
    true,
  );
});

it("draws figures of variants as dots with what they may be off by", () => {
  const pen = new RecordingPen();
  const ranks = [
    { name: "cold", value: 2, spread: 0.5 },
    { name: "warm", value: 3 },
  ];
  const { x } = paintRanks(pen, BOX, { label: "delay, samples", span: [0, 4], ranks }, LOOK);
  expect(pen.areas(BAR)).toHaveLength(2);
  const [whisker] = pen.lines(BAR);
  expect(whisker.points.map(([at]) => Math.round(at))).toEqual([x(1.5), x(2.5)].map(Math.round));
});
