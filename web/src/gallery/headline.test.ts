import { expect, it } from "vitest";
import type { GalleryCard } from "../api/types";
import { headlines, isNumber } from "./headline";

it.each([
  "approximately 12 %",
  "4335",
  "50 %",
  "1.67 um",
  "almost 80 % stronger",
  "2 um resolution (6.3)",
  "4 degrees",
])("takes %s for a number", (text) => expect(isNumber(text)).toBe(true));

it.each([
  "",
  "not given",
  "figure 1.3.4",
  "wrong in steps 1, 4, 6 to 7",
  "omega = sqrt(k/m) (second 1.3.5)",
  "quick",
])("takes %s for words", (text) => expect(isNumber(text)).toBe(false));

it("says our figure over the printed one with its unit", () => {
  const entry = (metric: string, published: string, measured: number | null) => ({ metric, published, measured });
  const card = {
    expectations: [
      entry("control.first_peak_pct", "50 %", 52.05),
      entry("control.effort_ratio", "reliable", 1),
      entry("lateral.fold_um", "1.67 um", null),
    ],
  } as unknown as GalleryCard;
  expect(headlines(card)).toEqual([
    { metric: "control.first_peak_pct", figure: "first peak", ours: "52.05\u00a0%", printed: "50\u00a0%" },
  ]);
});
