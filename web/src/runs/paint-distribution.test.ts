// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import type { Distribution } from "../api/types";
import { SvgPen, svgColour } from "../picture/svg-pen";
import { metricScale } from "../ui/metric-name";
import { contrast, rampColour } from "../ui/palette";
import { cellText, mostIn, paintDistribution, shareOf } from "./paint-distribution";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const extent = (name: string, low: number, high: number, cells: number) => ({ name, low, high, cells });
const DENSITY: Distribution = {
  runs: 112,
  x: extent("sensor.noise_um", 0, 2, 2),
  y: extent("control.rms_error_um", 10, 40, 3),
  counts: [
    [1, 0],
    [100, 10],
    [0, 1],
  ],
  dots: null,
};
const BOX = { width: 400, height: 300 };
const LOOK = { scheme: "dark", fontSize: 13 } as const;
const shown = (found: Distribution) => ({
  found,
  x: metricScale("noise_um", [found.x.low, found.x.high]),
  y: found.y ? metricScale(found.y.name, [found.y.low, found.y.high]) : undefined,
});

it("colours a cell by the logarithm of its runs, and leaves an empty one blank", () => {
  expect(mostIn(DENSITY)).toBe(100);
  expect([1, 10, 100].map((count) => shareOf(count, 100))).toEqual([0, 0.5, 1]);
  const pen = new SvgPen();
  paintDistribution(pen, BOX, shown(DENSITY), LOOK);
  const svg = pen.svg(BOX.width, BOX.height, "density");
  const fills = [0, 0.5, 1].map((share) => svgColour(rampColour(share, "dark")).colour);
  for (const [fill, times] of [
    [fills[0], 2],
    [fills[1], 1],
    [fills[2], 1],
  ] as const)
    expect(svg.split(fill).length - 1).toBe(times);
});

it("reads the cell under the pointer", () => {
  const plot = paintDistribution(new SvgPen(), BOX, shown(DENSITY), LOOK);
  const { left, right, top, bottom } = plot.field;
  const at = { x: left + 0.25 * (right - left), y: (top + bottom) / 2 };
  expect(cellText(shown(DENSITY), plot, at)).toBe("noise 0 to 1\u00a0µm, rms error 20 to 30\u00a0µm: 100\u00a0runs");
  expect(cellText(shown(DENSITY), plot, { x: 0, y: 0 })).toBeUndefined();
  const histogram = { ...DENSITY, y: null, counts: [[3, 1]] };
  expect(cellText(shown(histogram), plot, { ...at, x: right - 1 })).toBe("noise 1 to 2\u00a0µm: 1\u00a0run");
});

it("rises in contrast from few runs to many, on dark and on light", () => {
  for (const [scheme, panel] of [
    ["dark", "#161b21"],
    ["light", "#ffffff"],
  ] as const) {
    const steps = [0, 0.25, 0.5, 0.75, 1].map((share) => contrast(svgColour(rampColour(share, scheme)).colour, panel));
    expect(steps).toEqual([...steps].sort((a, b) => a - b));
    expect(steps[0]).toBeGreaterThan(1.4);
  }
});
