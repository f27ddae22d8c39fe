import { expect, it } from "vitest";
import { stack } from "./paint-race";

it("fills the height in every column that has data", () => {
  const edges = stack([Float32Array.of(0.25, 0.5, Number.NaN), Float32Array.of(0.75, 1.5, Number.NaN)]);
  expect([...edges[0]]).toEqual([0.25, 0.25, Number.NaN]);
  expect([...edges[1]]).toEqual([1, 1, Number.NaN]);
});
