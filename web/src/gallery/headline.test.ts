import { expect, it } from "vitest";
import type { GalleryCard } from "../api/types";
import { headlines } from "./headline";

it("says our figure over the printed number, both with their unit, where there are both", () => {
  const entry = (metric: string, published_value: number | null, measured: number | null) => ({
    metric,
    published: "50 % overshoot in the first peak",
    published_value,
    measured,
  });
  const card = {
    expectations: [
      entry("control.effort_ratio", null, 1),
      entry("lateral.fold_um", 1.67, null),
      entry("control.first_peak_pct", 50, 52.05),
    ],
  } as unknown as GalleryCard;
  expect(headlines(card)).toEqual([
    { metric: "control.first_peak_pct", figure: "first peak", ours: "52.05\u00a0%", printed: "50\u00a0%" },
  ]);
});
