// @vitest-environment jsdom
import { expect, it } from "vitest";
import { scoreWords } from "./live-values";

const names = ["healthy", "m+5"];

it("names hypotheses and counts in whole numbers", () => {
  expect(scoreWords("kalman.winner", 1, names)).toBe("mass +5\u00a0%");
  expect(scoreWords("kalman.truth", -1, names)).toBe("none of these");
  expect(scoreWords("kalman.false_switches", 17, names)).toBe("17");
  expect(scoreWords("kalman.delay", -1, names)).toBe("not found");
  expect(scoreWords("kalman.correct_fraction", 0.99997, names)).toBe("99.997\u00a0%");
  expect(scoreWords("kalman.log_likelihood", 0.97, names)).toBeUndefined();
});
