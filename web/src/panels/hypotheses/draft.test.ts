import { expect, it } from "vitest";
import { another, refusal, usualName, withFactor } from "./draft";

it.each([
  [{}, "healthy"],
  [{ mass: 1.05 }, "m+5"],
  [{ stiffness: 0.9, damping: 1.3 }, "k-10b+30"],
  [{ gain: 1.005 }, "g+0,5"],
])("%j is called %s", (hypothesis, name) => expect(usualName(hypothesis)).toBe(name));

it("lets a telling name follow the factor, and leaves a chosen one alone", () => {
  expect(withFactor({ name: "m+5", mass: 1.05 }, "mass", 10)).toEqual({ name: "m+10", mass: 1.1 });
  expect(withFactor({ name: "dirt", mass: 1.05 }, "mass", 10).name).toBe("dirt");
});

it("finds another that is not there", () => expect(another([{ name: "m+5", mass: 1.05 }]).name).toBe("m+10"));

it("says what is wrong with a list", () => {
  expect(refusal([{ name: "healthy" }])).toMatch(/at least 2/);
  expect(refusal([{ name: "a" }, { name: "a" }])).toBe("a appears twice.");
  expect(refusal([{ name: "a b" }, { name: "c" }])).toMatch(/cannot be a name/);
  expect(refusal([{ name: "a" }, { name: "b" }])).toBeUndefined();
});
