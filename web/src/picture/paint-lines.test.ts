// @vitest-environment jsdom
import { expect, it } from "vitest";
import { RecordingPen } from "../testing/recording-pen";
import { type LinesShown, nearestPoint, paintLines } from "./paint-lines";

const BOX = { width: 500, height: 300 };
const LOOK = { scheme: "light", fontSize: 12 } as const;

function painted(y: number[], spread: number[], rest: Partial<LinesShown> = {}) {
  const pen = new RecordingPen();
  const lines = [{ name: "", x: y.map((_, i) => i), y, spread }];
  const plot = paintLines(pen, BOX, { xLabel: "noise", yLabel: "error", lines, ...rest }, LOOK);
  const bars = pen
    .lines()
    .map(({ points }) => points)
    .filter(([from, to]) => from[0] === to[0] && y.some((_, i) => Math.abs(plot.x(i) - from[0]) < 0.01))
    .filter(([from, to]) => Math.abs(from[1] - to[1]) < plot.field.bottom - plot.field.top - 1);
  const ends = bars.map((points) => points.map(([, at]) => at).sort((a, b) => b - a));
  return { plot, lines, ends, height: plot.field.bottom - plot.field.top };
}

it("draws bars in proportion to the values: a deviation of a tenth of a thousandth is a hair", () => {
  const { ends, height } = painted([0.246992, 0.24698, 0.247], [0.000032, 0.000028, 0.00003]);
  expect(ends).toHaveLength(3);
  for (const [low, high] of ends) expect(low - high).toBeLessThan(0.05 * height);
});

it("leaves a bar at most half of the height where the values do not differ", () => {
  const { ends, height } = painted([736, 736, 736], [71, 71, 60]);
  for (const [low, high] of ends) expect(low - high).toBeLessThan(0.51 * height);
  expect(ends[0][0] - ends[0][1]).toBeGreaterThan(0.3 * height);
});

it("uses the height where runs do differ", () => {
  const { ends, height } = painted([1, 2, 3], [0.4, 0.5, 0.6]);
  for (const [low, high] of ends) expect(low - high).toBeGreaterThan(0.2 * height);
});

it("ends the bars of a count at 0, and those of a share at 1", () => {
  const counts = painted([0.2, 0.5], [0.7, 0.9], { yLimits: [0, Number.POSITIVE_INFINITY] });
  for (const [low] of counts.ends) expect(low).toBeCloseTo(counts.plot.y(0));
  expect(counts.plot.y(0)).toBeLessThanOrEqual(counts.plot.field.bottom);
  const shares = painted([0.99, 0.995], [0.02, 0.03], { yLimits: [0, 1] });
  for (const [, high] of shares.ends) expect(high).toBeCloseTo(shares.plot.y(1));
  expect(shares.plot.y(1) - shares.plot.field.top).toBeLessThan(0.1 * shares.height);
});

it("reads a point with its deviation on one power of ten", () => {
  const { plot, lines } = painted([7.09e-7, 7.1e-7], [7e-10, 7e-10]);
  const read = nearestPoint(lines, plot, { x: plot.x(0), y: plot.y(7.09e-7) });
  expect(read).toBe("0, 709.00e−9\u00a0±\u00a00.70e−9");
});
