// @vitest-environment jsdom
import { expect, it } from "vitest";
import { RecordingPen } from "../testing/recording-pen";
import { type ChartLine, nearestPoint, paintLines } from "./paint-lines";

const BOX = { width: 500, height: 300 };
const LOOK = { scheme: "light", fontSize: 12 } as const;

function painted(line: Partial<ChartLine>, yRange: [number, number] = [0, 4]) {
  const pen = new RecordingPen();
  const lines = [{ name: "", x: [0, 1, 2], y: [1, 2, 3], ...line }];
  const plot = paintLines(pen, BOX, { xLabel: "noise", yLabel: "error", lines, yRange }, LOOK);
  return { pen, plot, lines };
}

it("draws a line in a band as wide as its values may be off", () => {
  const { pen, plot } = painted({ spread: [0.4, 0.5, 0.6] });
  const [band] = pen.areas();
  const at = (x: number) => band.points.filter(([px]) => Math.abs(px - plot.x(x)) < 0.01).map(([, py]) => py);
  expect(Math.min(...at(1))).toBeCloseTo(plot.y(2.5));
  expect(Math.max(...at(1))).toBeCloseTo(plot.y(1.5));
  expect(Math.max(...at(2))).toBeCloseTo(plot.y(2.4));
  expect(band.colour.slice(0, 7)).toBe(pen.lines().at(-1)?.colour);
});

it("draws points alone where no line leads from one to the next", () => {
  const { pen } = painted({ isDotted: true });
  expect(pen.areas()).toHaveLength(3);
  expect(pen.lines()).toHaveLength(0);
});

it("says the point nearest to the pointer, in the words it is given", () => {
  const { plot, lines } = painted({ name: "kind pid" });
  const at = { x: plot.x(1) + 3, y: plot.y(2) };
  expect(nearestPoint(lines, plot, at)).toBe("kind pid: 1, 2");
  expect(nearestPoint(lines, plot, at, (line, point) => `${line} and ${point}`)).toBe("kind pid: 0 and 1");
  expect(nearestPoint(lines, plot, { x: plot.x(0), y: plot.y(4) })).toBeUndefined();
});
