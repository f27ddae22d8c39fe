import type { SheetBrief } from "../api/types";
import { formatShort } from "../ui/format";

/** The progress with a sheet: "step 3 of 7, 4.5 of 11 points". */
export const sheetWords = ({ step, steps, earned, points, done }: SheetBrief): string =>
  `${done ? "done" : `step ${step} of ${steps}`}, ${formatShort(earned, "")} of ${formatShort(points, "")} points`;
