import { expect, it } from "vitest";
import { BOX } from "./loop";
import { PARTNER, PARTNER_DRIVEN, PARTNER_WIRES, TWO_AXES, TWO_AXIS_WIRES, twoAxisBoxesOf } from "./two-axis-loop";

const boxes = [...TWO_AXES, PARTNER];
const onEdge = (x: number, y: number) =>
  boxes.some(
    (b) =>
      x >= b.x &&
      x <= b.x + BOX.width &&
      y >= b.y &&
      y <= b.y + BOX.height &&
      (x === b.x || x === b.x + BOX.width || y === b.y || y === b.y + BOX.height),
  );

/** Where a path of M, H and V ends. */
function end(d: string): [number, number] {
  let [x, y] = [0, 0];
  for (const [, kind, a, b] of d.matchAll(/([MHV])(\d+)(?: (\d+))?/g)) {
    if (kind === "M") [x, y] = [Number(a), Number(b)];
    else if (kind === "H") x = Number(a);
    else y = Number(a);
  }
  return [x, y];
}

it("leads every wire to the edge of a box", () => {
  for (const { d } of [...TWO_AXIS_WIRES, ...PARTNER_WIRES, PARTNER_DRIVEN]) expect(onEdge(...end(d)), d).toBe(true);
});

it("keeps the boxes apart", () => {
  for (const a of boxes)
    for (const b of boxes)
      expect(a === b || Math.abs(a.x - b.x) >= BOX.width || Math.abs(a.y - b.y) >= BOX.height).toBe(true);
});

it("shows a fault where it is seen", () => {
  expect(["sensor", "drive", "beams", null].map(twoAxisBoxesOf)).toEqual([
    ["pick_x", "pick_y"],
    ["force_x"],
    ["plant"],
    ["plant"],
  ]);
});
