import { expect, test } from "vitest";
import type { BenchmarkRow } from "../api/types";
import { delayLines, reliabilityLines } from "./curves";

const named = (unit: string) => `the ${unit}`;
const row = (unit: string, part: Partial<BenchmarkRow>) =>
  ({ unit, reliability: [], found_within: [], ...part }) as BenchmarkRow;

test("reliability is drawn over the diagonal, without bins that hardly have a sample", () => {
  const bins = [
    { samples: 0, said: 0, right: 0 },
    { samples: 99, said: 0.4, right: 1 },
    { samples: 500, said: 0.9, right: 0.7 },
  ];
  const lines = reliabilityLines([row("kalman", { reliability: bins }), row("regions", {})], named);
  expect(lines.map((line) => line.name)).toEqual(["as often right as said", "the kalman"]);
  expect(lines[1]).toEqual({ name: "the kalman", x: [0.9], y: [0.7] });
});

test("faults found start at none, and a diagnoser without delays has no line", () => {
  const lines = delayLines([row("imm", { found_within: [0.2, 0.9] }), row("silent", {})], [10, 500], named);
  expect(lines).toEqual([{ name: "the imm", x: [0, 10, 500], y: [0, 0.2, 0.9] }]);
});
