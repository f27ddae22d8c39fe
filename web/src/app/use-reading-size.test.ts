// @vitest-environment jsdom
import { expect, it } from "vitest";
import { readingScale } from "./use-reading-size";

it("grows a lecture with the shorter way of the window, and nothing else", () => {
  expect(readingScale(true, 1366, 768)).toBe(1);
  expect(readingScale(true, 820, 1180)).toBe(1);
  expect(readingScale(true, 1920, 1080)).toBeCloseTo(1.41, 2);
  expect(readingScale(true, 3840, 1080)).toBeCloseTo(1.41, 2);
  expect(readingScale(true, 3840, 2160)).toBeCloseTo(2.81, 2);
  expect(readingScale(true, 7680, 4320)).toBe(3);
  expect(readingScale(false, 3840, 2160)).toBe(1);
});
