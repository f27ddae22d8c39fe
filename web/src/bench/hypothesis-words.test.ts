import { expect, it } from "vitest";
import type { Bench } from "../api/types";
import { hypothesisWords } from "./hypothesis-words";

const DIAGNOSERS: Bench["diagnosers"] = {
  kalman: {
    kind: "mmae",
    names: ["healthy", "m+5", "k2.5g-20", "q500", "soft"],
    factors: [
      {},
      { mass: 1.05 },
      { stiffness: 1.025, gain: 0.8 },
      { quadrature_dps: 500 },
      { stiffness: 0.97 },
    ] as Record<string, number>[],
  },
  imm: { kind: "imm", names: ["m+5", "b+30"], factors: [{ mass: 1.05 }, { damping: 1.3 }] as Record<string, number>[] },
};

it("says what a hypothesis changes, in percent or in the unit of what it adds", () => {
  const words = (name: string) => hypothesisWords(name, DIAGNOSERS);
  expect(words("m+5")).toBe("mass +5\u00a0%");
  expect(words("k2.5g-20")).toBe("stiffness +2.5\u00a0%, drive gain −20\u00a0%");
  expect(words("q500")).toBe("quadrature +500\u00a0deg/s");
  expect(words("b+30")).toBe("damping +30\u00a0%");
});

it("keeps a name of words, and that of one that changes nothing or is not known", () => {
  const names = ["healthy", "q+5", "soft", "k2.5g"];
  expect(names.map((name) => hypothesisWords(name, DIAGNOSERS))).toEqual(names);
});

it("spells out an abbreviation of another bench, as in a vote", () => {
  expect(hypothesisWords("k+5", DIAGNOSERS)).toBe("stiffness +5\u00a0%");
  expect(hypothesisWords("b-30", {})).toBe("damping −30\u00a0%");
});
