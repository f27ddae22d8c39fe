// @vitest-environment jsdom
import { expect, it } from "vitest";
import { meterShare } from "./excitation-meter";

it.each([
  [1, 1],
  [1e-9, 0],
  [0, 0],
  [Number.NaN, 0],
  [10, 1],
])("%s is at %s", (value, share) => expect(meterShare(value)).toBe(share));

it("is logarithmic", () => expect(meterShare(1e-3) - meterShare(1e-6)).toBeCloseTo(1 / 3));
