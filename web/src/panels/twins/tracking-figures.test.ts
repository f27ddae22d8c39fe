import { expect, it } from "vitest";
import type { PanelFrame } from "../../stream/panel-frame";
import { trackingFigures } from "./tracking-figures";

it("gives rms and peak of the error and rms of the voltage", () => {
  const rows = [
    [1, 2, Number.NaN],
    [1, 0, 5],
    [3, 4, 1],
  ];
  const data = Float32Array.from(rows.flatMap((row) => [...row, ...row]));
  const frame = { data, columns: 3 } as unknown as PanelFrame;
  const found = trackingFigures(frame, 0, 1, [2]);
  expect(found.rmsError).toBeCloseTo(Math.sqrt(2)); // errors 0 and 2
  expect(found.peakError).toBe(2);
  expect(found.efforts[0]).toBeCloseTo(Math.sqrt(12.5)); // 3 and 4 V
});
