import { expect, it } from "vitest";
import { faultsOf, hiddenFault, points } from "./hidden-fault";

const NAMES = ["healthy", "m+5", "k+5", "b+30"];

it("hides the same for the same seed, and each answer about equally often over many", () => {
  expect(hiddenFault(7, NAMES, 0.01)).toEqual(hiddenFault(7, NAMES, 0.01));
  const counts = new Map(NAMES.map((name) => [name, 0]));
  for (let seed = 1; seed <= 4000; seed += 1) {
    const { answer, delayTicks } = hiddenFault(seed, NAMES, 0.01);
    counts.set(answer, (counts.get(answer) ?? 0) + 1);
    expect(delayTicks).toBeGreaterThanOrEqual(200);
    expect(delayTicks).toBeLessThanOrEqual(800);
  }
  // 1000 each; five standard deviations are 137
  for (const count of counts.values()) expect(Math.abs(count - 1000)).toBeLessThan(137);
});

it("makes a hypothesis true by one fault for each factor", () => {
  expect(faultsOf({ name: "healthy" })).toEqual([]);
  expect(faultsOf({ name: "x", mass: 1.05, gain: 0.9 })).toEqual([
    { fault: "added_mass", severity: 0.05 },
    { fault: "drive_gain", severity: -0.1 },
  ]);
});

it("pays best to say what one believes", () => {
  expect(points(true, 1, 4)).toBe(100);
  expect(points(false, 1, 4)).toBe(0);
  const belief = 0.7;
  const expected = (said: number) => belief * points(true, said, 4) + (1 - belief) * points(false, said, 4);
  for (const other of [0.25, 0.4, 0.6, 0.8, 1]) expect(expected(belief)).toBeGreaterThan(expected(other));
});
