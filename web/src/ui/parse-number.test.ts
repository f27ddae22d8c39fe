import { expect, it } from "vitest";
import { nudge, parseNumber } from "./parse-number";

const free = { minimum: null, maximum: null, integer: false };

it("reads any notation people type", () => {
  expect(["0.05", "0,05", "5e-2", " .05 ", "−1"].map((t) => parseNumber(t, free))).toEqual([
    0.05, 0.05, 0.05, 0.05, -1,
  ]);
});

it("says what is wrong", () => {
  expect(parseNumber("", free)).toBe("not a number");
  expect(parseNumber("abc", free)).toBe("not a number");
  expect(parseNumber("-1", { ...free, minimum: 0 })).toBe("at least 0");
  expect(parseNumber("11", { ...free, maximum: 10 })).toBe("at most 10");
  expect(parseNumber("1.5", { ...free, integer: true })).toBe("whole numbers only");
});

it("nudges by a unit of the second digit", () => {
  expect(nudge(3, 1, false)).toBe(3.1);
  expect(nudge(0.05, -1, false)).toBe(0.049);
  expect(nudge(7, 1, true)).toBe(8);
});
