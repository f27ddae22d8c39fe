import { expect, it } from "vitest";
import { Strain } from "./strain";

it("is called after two slow seconds in a row, not after one", () => {
  const strain = new Strain();
  for (const mean of [40, 16, 40]) strain.second(mean);
  expect(strain.strained).toBe(false);
  strain.second(40);
  expect(strain.strained).toBe(true);
});

it("rests for half a minute before it tries again", () => {
  const strain = new Strain();
  strain.second(40);
  strain.second(40);
  for (let s = 0; s < 29; s += 1) strain.second(16);
  expect(strain.strained).toBe(true);
  strain.second(16);
  expect(strain.strained).toBe(false);
});
