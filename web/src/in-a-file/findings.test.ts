import { expect, it } from "vitest";
import type { FileDocument } from "./file-document";
import { Findings } from "./findings";

const TOLD = [
  { kind: "delay", diagnoser: "bank" },
  { kind: "truth", diagnoser: "bank" },
  { kind: "verdict", diagnoser: "bank", words: ["normal", "detected", "isolated"], left: [2], columns: [4, 5] },
  { kind: "warning", text: "drive: at its limit" },
];
const document = {
  dt_ms: 0.01,
  followed: { columns: BigInt64Array.from([0n, 1n, 2n, 3n]), last: new Float64Array(4), told: TOLD },
  diagnosers: { bank: { names: ["healthy", "m+5"] } },
} as unknown as FileDocument;

const look = (last: number[], ...signals: number[]) =>
  new Findings(document).look(Float64Array.from(signals), Float64Array.from(last)).map(({ text }) => text);

it("tells nothing of signals that stay, also where they are no numbers", () => {
  expect(look([-1, Number.NaN, 0, 0], -1, Number.NaN, 0, 0, 0, 0)).toEqual([]);
});

it("tells a change of the truth before its recognition, whatever the order of the signals", () => {
  expect(look([-1, 0, 0, 0], 12, 1, 0, 0, 0, 0)).toEqual([
    "bank: the truth is m+5",
    "bank found m+5 after 12\u00a0samples (120\u00a0µs)",
  ]);
  expect(look([3, 1, 0, 0], -1, -2, 0, 0, 0, 0)).toEqual(["bank: the truth is none of the hypotheses"]);
});

it("names the hypotheses that are left, and warns when a warning rises, not when it falls", () => {
  expect(look([-1, 0, 0, 0], -1, 0, 2, 1, 0, 1)).toEqual(["drive: at its limit", "bank: isolated: m+5"]);
  expect(look([-1, 0, 0, 1], -1, 0, 0, 0, 0, 1)).toEqual([]);
});

it("keeps the numbers of now", () => {
  const last = new Float64Array([-1, 0, 0, 0]);
  new Findings(document).look(Float64Array.from([5, 1, 0, 0, 0, 0]), last);
  expect([...last]).toEqual([5, 1, 0, 0]);
});
