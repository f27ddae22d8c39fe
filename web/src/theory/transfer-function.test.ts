import { expect, it } from "vitest";
import { highestFirst, parseTransferFunction, transferLatex } from "./transfer-function";

it.each([
  ["(s+1)/(s^2+5s+6)", [1, 1], [1, 5, 6]],
  ["1/(s(s+2))", [1], [1, 2, 0]],
  ["(s+1)(s+2)/(s+3)^2", [1, 3, 2], [1, 6, 9]],
  ["2.5e-1 s - 3", [0.25, -3], [1]],
  ["-(s-1)/(p+2)", [-1, 1], [1, 2]],
  ["1 + 1/s", [1, 1], [1, 0]],
  ["(s+1)/(s+1)", [1, 1], [1, 1]],
  ["1/2s", [0.5, 0], [1]],
])("reads %s", (text, numerator, denominator) => {
  const found = parseTransferFunction(text);
  const scale = highestFirst(found.denominator)[0] / denominator[0];
  expect(highestFirst(found.numerator).map((x) => x / scale)).toEqual(numerator);
  expect(highestFirst(found.denominator).map((x) => x / scale)).toEqual(denominator);
});

it.each([
  ["", "nothing is there yet"],
  ["(s+1", "a bracket is not closed"],
  ["s+", "it ends too early"],
  ["s^1.5", "a power must be a whole number from 0 to 20"],
  ["1/(s-s)", "it divides by zero"],
  ["x+1", "x is not understood"],
  ["s)", ") is not expected here"],
  ["s-s", "it is zero"],
])("says what is wrong with '%s'", (text, why) => expect(() => parseTransferFunction(text)).toThrow(why));

it("sets it as an equation", () => {
  expect(transferLatex(parseTransferFunction("(s-1)/(s^2+0.5)"))).toBe("G(s)=\\frac{s-1}{s^{2}+0.5}");
  expect(transferLatex(parseTransferFunction("2s"))).toBe("G(s)=2s");
});
