import { expect, it } from "vitest";
import { deviceDrawing, rectPath } from "./device-drawing";

const geometry = {
  thickness_um: 2,
  beam_length_um: 350,
  beam_width_um: 2,
  beam_bias_um: 0.25,
  truss_width_um: 4,
  truss_segment_um: 30,
  fingers: 87,
  finger_length_um: 60,
  finger_width_um: 2,
  finger_gap_um: 2,
  comb_bias_um: 0.05,
  overlap_um: 40,
  plate_length_um: 190,
  plate_width_um: 75,
  arm_width_um: 11,
  arm_length_um: 690,
};

it("draws eight beams of the etched width from their roots to the trusses", () => {
  const { beams, trusses } = deviceDrawing(geometry);
  expect(beams).toHaveLength(8);
  for (const beam of beams) {
    expect(beam.width).toBeCloseTo(1.5);
    expect(beam.height).toBe(350);
    expect(Math.min(Math.abs(beam.y), Math.abs(beam.y + beam.height))).toBeCloseTo(37.5);
  }
  expect(beams.slice(0, 4).map((b) => b.x + b.width / 2)).toEqual([-45, -15, 15, 45]);
  expect(trusses.map((t) => t.height)).toEqual([3.5, 3.5]);
});

it("lets rotor and stator fingers overlap as drawn, with the etched gap between them", () => {
  const { rotor, stators } = deviceDrawing(geometry);
  expect(rotor).toHaveLength(2 * 87);
  const right = rotor.filter((r) => r.x > 0)[0];
  const facing = stators.filter((s) => s.x > 0 && s.width === 60)[1];
  expect(right.x + right.width - facing.x).toBeCloseTo(40);
  expect(facing.y - (right.y + right.height)).toBeCloseTo(2.1);
});

it("keeps all parts within its size", () => {
  const drawing = deviceDrawing(geometry);
  for (const rect of [...drawing.stators, ...drawing.trusses, ...drawing.arms, ...drawing.plate]) {
    expect(Math.abs(rect.x) - 1e-9).toBeLessThanOrEqual(drawing.width / 2);
    expect(Math.abs(rect.y + rect.height)).toBeLessThanOrEqual(drawing.height / 2);
  }
  expect(rectPath([{ x: 0, y: 1, width: 2, height: 3 }])).toBe("M0 1h2v3h-2z");
});
