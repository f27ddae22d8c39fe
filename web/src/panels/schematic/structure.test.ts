import { describe, expect, it } from "vitest";
import { BOX } from "./loop";
import { type Parts, structureOf } from "./structure";

const PARTS: Parts = {
  controller: "open_loop",
  augments: true,
  sensor: "ideal",
  light: "through_wafer",
  hasDiagnoser: false,
  hasIdentifier: false,
  isSupervised: false,
};
const FIGURES: [figure: string | undefined, parts: Partial<Parts>][] = [
  [undefined, {}],
  ["2.2.1", { controller: "mrac_velocity" }],
  ["2.2.1", { controller: "mrac", augments: false }],
  ["3.1.2.1.1", { controller: "mrac" }],
  ["3.3.2.1", { controller: "indirect_mrac" }],
  ["2.2.3.1", { controller: "stvsc" }],
  ["3.2.6.1", { controller: "stvsc", sensor: "single_beam" }],
  ["3.2.6.1", { sensor: "peak_valley", light: "doppler" }],
  ["3.2.6.1", { sensor: "quadrature" }],
  [undefined, { controller: "mrac", hasIdentifier: true }],
];

/** Where a path of M, H and V begins and ends. */
function ends(d: string): [number, number][] {
  let [x, y] = [0, 0];
  const points: [number, number][] = [];
  for (const [, kind, a, b] of d.matchAll(/([MHV])(\d+)(?: (\d+))?/g)) {
    if (kind === "M") [x, y] = [Number(a), Number(b)];
    else if (kind === "H") x = Number(a);
    else y = Number(a);
    points.push([x, y]);
  }
  return [points[0], points[points.length - 1]];
}

describe.each(FIGURES)("drawn as figure %s", (figure, chosen) => {
  it.each([false, true])("has its boxes apart and its wires on their edges, with a diagnoser: %s", (hasDiagnoser) => {
    const structure = structureOf({ ...PARTS, ...chosen, hasDiagnoser, isSupervised: true });
    expect(structure.wires.some(({ acts }) => acts)).toBe(hasDiagnoser);
    expect(structure.figure).toBe(figure);
    const boxes = [...structure.boxes, ...structure.extra];
    for (const a of boxes)
      for (const b of boxes)
        expect(a === b || Math.abs(a.x - b.x) >= BOX.width || Math.abs(a.y - b.y) >= BOX.height, a.id).toBe(true);
    const touches = ([x, y]: [number, number]) =>
      boxes.some(
        (b) =>
          ((x === b.x || x === b.x + BOX.width) && y >= b.y && y <= b.y + BOX.height) ||
          ((y === b.y || y === b.y + BOX.height) && x >= b.x && x <= b.x + BOX.width),
      );
    for (const { id, d } of structure.wires) expect(touches(ends(d)[1]), id).toBe(true);
    expect(new Set(structure.wires.map((wire) => wire.id)).size).toBe(structure.wires.length);
    expect(new Set(boxes.map((box) => box.id)).size).toBe(boxes.length);
    expect(structure.boxes.some((box) => box.id === "diagnosis")).toBe(hasDiagnoser || figure === undefined);
    expect(structure.hasRoom).toBe(!boxes.some((box) => box.x === 235 && box.y === 166));
  });
});

it("tells the light from the unit that looks at it", () => {
  const light = (parts: Partial<Parts>) => structureOf({ ...PARTS, ...parts }).extra.map((box) => box.signal)[1];
  expect(light({ sensor: "single_beam" })).toBe("through_wafer.intensity");
  expect(light({ sensor: "peak_valley", light: "doppler" })).toBe("doppler.velocity");
  expect(light({ sensor: "quadrature_kalman" })).toBe("dual_beam.first");
});
