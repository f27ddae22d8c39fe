// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import { linearAxis, logAxis, paintAxes, paintColumns, placeOn, squareWithin, timeAxis } from "./axes";
import { PAPER } from "./pen";
import { SvgPen } from "./svg-pen";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

function painted(paint: (pen: SvgPen) => void) {
  const pen = new SvgPen();
  paint(pen);
  const document = new DOMParser().parseFromString(pen.svg(400, 300, "t"), "image/svg+xml");
  return [...document.querySelectorAll("text")].map((node) => node.textContent);
}

it("places values evenly, or by their ratio on a logarithmic axis", () => {
  expect(placeOn({ range: [-1, 1] }, 0, 100)(0)).toBe(50);
  const place = placeOn({ range: [1, 100], isLog: true }, 0, 100);
  expect(place(10)).toBeCloseTo(50);
  expect(place(0)).toBeLessThan(-1000);
});

it.each([
  [[-3, 3], 2.97],
  [[-2.9, 2.9], 1],
  [[0, 19], 2],
  [[0.5, 8.6], 2],
] as const)("has more than one number from end to end of %s where %s have room", (range, count) => {
  expect(linearAxis(range).ticks(count).length).toBeGreaterThan(1);
});

it("counts device time from its origin and says it in the unit of the span", () => {
  const axis = timeAxis({ start: 900, end: 1300 }, 0.01, 1000);
  expect(axis.ticks(4)).toEqual([900, 1000, 1100, 1200, 1300]);
  expect(axis.say(axis.ticks(4))).toEqual(["−1", "0", "1", "2", "3"]);
  expect(axis.unit).toBe("ms");
});

it("writes titles and numbers of both axes, and leaves out numbers without room", () => {
  const box = { width: 300, height: 200 };
  const texts = painted((pen) => {
    const everywhere = { ...linearAxis([0, 100], "time, ms"), ticks: () => Array.from({ length: 101 }, (_, i) => i) };
    paintAxes(pen, box, everywhere, logAxis([1, 1000], "gain", String), PAPER);
  });
  expect(texts).toEqual(expect.arrayContaining(["time, ms", "gain", "1", "10", "100", "1000"]));
  expect(texts.filter((text) => /^\d+$/.test(text ?? "")).length).toBeLessThan(24);
});

it("leaves out the numbers that a picture would cut at its edges", () => {
  const field = { left: 0, right: 400, top: 0, bottom: 100 };
  const axis = linearAxis([0, 4]);
  expect(painted((pen) => paintColumns(pen, field, axis, PAPER)).slice(0)).toContain("0");
  const kept = painted((pen) => paintColumns(pen, field, axis, PAPER, [0, 400]));
  expect(kept).toContain("2");
  expect(kept.filter((text) => text === "0" || text === "4")).toEqual([]);
});

it("gives both axes one scale where a unit across is as long as one up", () => {
  const pen = new SvgPen();
  const box = { width: 400, height: 200 };
  const { x, y } = paintAxes(pen, box, linearAxis([-1, 1]), linearAxis([-1, 1]), PAPER, { isAlike: true });
  expect(x(1) - x(0)).toBeCloseTo(y(0) - y(1));
});

it.each([
  [900, 240],
  [240, 900],
  [81, 81],
])("keeps a square in the middle of %i by %i px, as large as it can be", (width, height) => {
  const { left, top, right, bottom } = squareWithin({ left: 0, right: width, top: 0, bottom: height });
  expect(right - left).toBe(Math.min(width, height));
  expect(bottom - top).toBe(right - left);
  expect(Math.abs(left - (width - right))).toBeLessThanOrEqual(1);
  expect(Math.abs(top - (height - bottom))).toBeLessThanOrEqual(1);
});
