import { expect, it } from "vitest";
import { Magnifier } from "./magnifier";

it("draws a small swing as large as it can be seen, by a round factor that stays", () => {
  const one = new Magnifier();
  const factors = [0.5, 0.1, -0.6, 0.4, 0].map((um) => one.of(um, 500));
  expect(new Set(factors)).toEqual(new Set([20]));
});

it("follows a swing that grows or dies, and never shrinks one", () => {
  const one = new Magnifier();
  expect(one.of(0.5, 500)).toBe(20);
  expect(one.of(5, 500)).toBe(2);
  expect(one.of(300, 500)).toBe(1);
  for (let i = 0; i < 8000; i += 1) one.of(0.05, 500);
  expect(one.of(0.05, 500)).toBe(200);
});

it("moves nothing that stands still", () => expect(new Magnifier().of(0, 500)).toBe(1));
