import { expect, it } from "vitest";
import { countFitting, shareTheRest } from "./use-legend-row";

it.each([
  [[100, 100, 100], 300, 3],
  [[100, 100, 100], 299, 2], // 34 are kept for the button
  [[100, 100, 100], 233, 1],
  [[100, 100, 100], 120, 0],
  [[], 50, 0],
])("%o in %i px: %i", (widths, room, fits) => expect(countFitting(widths, room, 34)).toBe(fits));

it("leaves out what all names have in common only where the blocks tell them apart", () => {
  const named = (...names: string[]) => shareTheRest(names.map((name) => ({ name })));
  expect(named("model.displacement", "plant.displacement")).toBe(true);
  expect(named("model.displacement", "plant.velocity")).toBe(false);
  expect(named("plant.displacement")).toBe(false);
});
