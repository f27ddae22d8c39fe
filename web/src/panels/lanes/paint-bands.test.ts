import { expect, it } from "vitest";
import { runs } from "./paint-bands";

it("joins equal neighbours and bridges columns without data", () => {
  const columns = Float32Array.from([Number.NaN, 0, 0, Number.NaN, 2, 2, -1]);
  expect(runs(columns)).toEqual([
    { value: 0, from: 1, to: 4 },
    { value: 2, from: 4, to: 6 },
    { value: -1, from: 6, to: 7 },
  ]);
});

it("finds nothing in nothing", () => expect(runs(new Float32Array([Number.NaN]))).toEqual([]));
