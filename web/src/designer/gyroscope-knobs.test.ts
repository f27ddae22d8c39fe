import { expect, it } from "vitest";
import { DRAWN_GYROSCOPE, gyroscopeKnobs } from "./gyroscope-knobs";

const values: Record<string, number> = {
  "gyroscope.mass_x_kg": 2e-7,
  "gyroscope.stiffness_x_n_m": 60,
  "gyroscope.stiffness_y_n_m": 100,
  "gyroscope.stiffness_xy_n_m": 0,
  "gyroscope.alpha_deg": 2,
};
const knobs = gyroscopeKnobs((path) => values[path]).flatMap((group) => group.knobs);
const knob = (name: string) => knobs.find((k) => k.path === `gyroscope.${name}`);

it("turns what the device has, and nothing else", () =>
  expect(knobs.map((k) => k.path.slice(10))).toEqual([
    "mass_x_kg",
    "stiffness_x_n_m",
    "stiffness_y_n_m",
    "stiffness_xy_n_m",
    "alpha_deg",
  ]));

it("turns by ratios what cannot be 0, and to both sides what can", () => {
  expect(knob("mass_x_kg")).toMatchObject({ low: 5e-8, high: 8e-7, log: true });
  // a fifth of the softer axis: the cross term must stay below the root of 60 times 100
  expect(knob("stiffness_xy_n_m")).toMatchObject({ low: -10, high: 10, step: 0.05 });
  expect(knob("alpha_deg")).toMatchObject({ low: -10, high: 10 });
});

it("turns the drawing of both axes once each, and the bias of the combs of each axis", () => {
  const paths = DRAWN_GYROSCOPE.flatMap((group) => group.knobs.map((k) => k.path));
  expect(new Set(paths).size).toBe(paths.length);
  expect(paths).toContain("geometry.beam_length_um");
  expect(paths).toContain("drawn_gyroscope.sense_beam_length_um");
  expect(paths).not.toContain("bias_v");
  expect(paths).toContain("electrodes.sense.bias_v");
  const labels = DRAWN_GYROSCOPE.flatMap((group) => group.knobs.map((k) => k.label));
  expect(labels.filter((label) => label.endsWith(" along x")).sort()).toEqual([
    "Beam length along x",
    "Bias along x",
    "Fingers per side along x",
  ]);
  expect(labels).toContain("Beam width along x, drawn");
  expect(labels).toContain("Finger width, drawn");
});
