// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import type { CampaignPicture } from "../api/types";
import { SvgPen } from "../picture/svg-pen";
import { RecordingPen } from "../testing/recording-pen";
import { metricScale } from "../ui/metric-name";
import { rampColour } from "../ui/palette";
import { mapOf, paintMap, pointAt } from "./paint-map";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const BOX = { width: 500, height: 300 };
const LOOK = { scheme: "light", fontSize: 12 } as const;
/** A grid of three noises and two masses; one point has no result yet. */
const PICTURE: CampaignPicture = {
  kind: "map",
  figure: "control.rms_error_um",
  figures: ["control.rms_error_um"],
  across: "sensor.noise_um",
  up: "faults.mass_pct",
  low: 0,
  high: 0.4,
  parts: [
    {
      labels: {},
      x: [0.01, 0.01, 0.1, 0.1, 0.05],
      y: [5, 10, 5, 10, 5],
      mean: [0.1, 0.2, 0.3, 0.4, 0.25],
      std: [0, 0, 0, 0.01, 0],
    },
  ],
  left_out: 0,
  ranking: [],
  chance: 1,
};
const shown = mapOf(PICTURE, PICTURE.parts[0], metricScale(PICTURE.figure, PICTURE.parts[0].mean));

it("gives each value of the grid a place of one width, in ascending order, and each point its colour", () => {
  const pen = new RecordingPen();
  const plot = paintMap(pen, BOX, shown, LOOK);
  expect(pen.words).toEqual(expect.arrayContaining(["0.01", "0.05", "0.1", "5", "10", "noise, µm", "mass, %"]));
  const cells = shown.part.mean.map((mean, i) => {
    const [cell] = pen.rects(rampColour(mean / 0.4, "light")).filter(({ right, left }) => right - left > 50);
    expect(plot.x(shown.columns.indexOf(shown.part.x[i]))).toBeCloseTo(cell.left, 0);
    expect(plot.y(shown.rows.indexOf(shown.part.y[i]) + 1)).toBeCloseTo(cell.top, 0);
    return cell.right - cell.left;
  });
  for (const wide of cells) expect(Math.abs(wide - cells[0])).toBeLessThanOrEqual(1);
});

it("shows what the colours mean, from the least to the most", () => {
  const pen = new RecordingPen();
  const { field } = paintMap(pen, BOX, shown, LOOK);
  const beside = pen.texts.filter(({ points: [[x]] }) => x > field.right).map(({ text }) => text);
  expect(beside.length).toBeGreaterThan(2);
  expect([beside[0], beside.at(-1)].map(Number)).toEqual([0, 0.4]);
});

it("reads the point under the pointer, and nothing where there is none", () => {
  const plot = paintMap(new RecordingPen(), BOX, shown, LOOK);
  expect(pointAt(shown, plot, { x: plot.x(2.5), y: plot.y(1.5) })).toBe(3);
  expect(pointAt(shown, plot, { x: plot.x(1.5), y: plot.y(0.5) })).toBe(4);
  expect(pointAt(shown, plot, { x: plot.x(1.5), y: plot.y(1.5) })).toBeUndefined();
  expect(pointAt(shown, plot, { x: 0, y: 0 })).toBeUndefined();
});

it("is written down as SVG by the same lines", () => {
  const pen = new SvgPen();
  paintMap(pen, BOX, shown, LOOK);
  const svg = pen.svg(BOX.width, BOX.height, "rms error");
  expect(svg.match(/<rect /g)?.length).toBeGreaterThan(5 + 40);
  expect(svg).not.toMatch(/NaN|undefined/);
});
