import { expect, it } from "vitest";
import type { Device } from "../api/types";
import {
  benchOf,
  catalogued,
  changed,
  designDocument,
  gyroscopeBenchOf,
  isGyroscope,
  newDesign,
  tableIn,
  valueIn,
  withFringing,
  withTable,
} from "./design";

const device = {
  id: "lcr-350",
  parameters: { bias_v: 10, geometry: { beam_length_um: 350 } },
} as unknown as Device;

it("writes only what was changed, geometry in its own table", () => {
  let state = changed(newDesign("lcr-350"), "geometry.beam_length_um", 300, 350);
  state = changed(state, "bias_v", 12, 10);
  expect(designDocument(state)).toEqual({
    device: { id: "lcr-350", bias_v: 12, geometry: { beam_length_um: 300 } },
    environment: {},
  });
  expect(designDocument(changed(state, "bias_v", 10, 10)).device).not.toHaveProperty("bias_v");
});

it("lets a change win over what the process drew", () => {
  const drawn = { ...newDesign("lcr-350"), drawn: { seed: 3, geometry: { thickness_um: 1.93, beam_bias_um: 0.3 } } };
  expect(valueIn(drawn, "geometry.thickness_um", 2)).toBe(1.93);
  const state = changed(drawn, "geometry.thickness_um", 2.1, 2);
  expect(valueIn(state, "geometry.thickness_um", 2)).toBe(2.1);
  expect(designDocument(state).device).toEqual({ id: "lcr-350", geometry: { thickness_um: 2.1, beam_bias_um: 0.3 } });
  const back = changed(state, "geometry.thickness_um", 2, 2);
  expect(valueIn(back, "geometry.thickness_um", 2)).toBe(2);
});

it("reads the catalogue by path", () => {
  expect(catalogued(device, "geometry.beam_length_um")).toBe(350);
  expect(catalogued(device, "mass_kg")).toBeUndefined();
});

it("drives the bench below resonance, within some micrometres", () => {
  const body = benchOf({ device: { id: "x" } }, "X", {
    f0_hz: 2484,
    static_gain_um_per_v: -0.545,
    quality_factor: 4.86,
  });
  expect(body.set).toMatchObject({ "reference.frequency_hz": 2000, sample_rate_khz: 100 });
  const amplitude = body.set?.["reference.amplitude_v"] as number;
  // |H| at 0.8 f0 is 1 / |0.36 + 0.8j / Q|
  expect((amplitude * 0.545) / Math.hypot(0.36, 0.8 / 4.86)).toBeCloseTo(3, 0);
  const fast = benchOf({}, "X", { f0_hz: 40_000, static_gain_um_per_v: -1e-4, quality_factor: 50 });
  expect(fast.set).toMatchObject({ sample_rate_khz: 800, "reference.amplitude_v": 10 });
});

it("writes each table of a device once, and puts a gyroscope on a bench that reads its rate", () => {
  let state = changed(newDesign("gyro-c"), "gyroscope.alpha_deg", 1, 0);
  state = changed(state, "gyroscope.mass_x_kg", 2e-6, 1e-6);
  const design = designDocument(state);
  expect(design.device).toEqual({ id: "gyro-c", gyroscope: { alpha_deg: 1, mass_x_kg: 2e-6 } });
  const { scenario } = gyroscopeBenchOf(design, "C", { f0_hz: 17_568 });
  // twenty samples of each period of the carrier
  expect(scenario).toMatchObject({
    device: design.device,
    sample_rate_khz: 352,
    controller: { kind: "force_to_rebalance" },
  });
});

it("keeps the drawing of a gyroscope and what y has beside it in a table each", () => {
  const drawn = { id: "g", parameters: { geometry: { fingers: 87 }, drawn_gyroscope: {} } } as unknown as Device;
  expect([isGyroscope(drawn), isGyroscope(device)]).toEqual([true, false]);
  let state = changed(newDesign("g"), "geometry.fingers", 60, 87);
  state = changed(state, "drawn_gyroscope.sense_fingers", 40, 87);
  expect(designDocument(state).device).toEqual({
    id: "g",
    geometry: { fingers: 60 },
    drawn_gyroscope: { sense_fingers: 40 },
  });
});

it("gives a gyroscope an electrode with all its numbers, and takes it away whole", () => {
  const comb = { bias_v: 10, fingers: 100 };
  let state = withTable(newDesign("gyro-c"), "electrodes.drive", comb);
  state = withTable(state, "electrodes.tuning", { gap_um: 3 });
  expect(designDocument(state).device).toEqual({
    id: "gyro-c",
    electrodes: { drive: comb, tuning: { gap_um: 3 } },
  });
  expect(tableIn(state, "electrodes.drive")).toEqual(comb);
  state = withTable(state, "electrodes.drive", undefined);
  expect(tableIn(state, "electrodes.drive")).toBeUndefined();
  expect(designDocument(state).device).toEqual({ id: "gyro-c", electrodes: { tuning: { gap_um: 3 } } });
});

it("drives combs by volts where both axes have them, and tunes where there are plates", () => {
  const both = { f0_hz: 4000, "gyro.force_x_nn_per_v2": 3, "gyro.force_y_nn_per_v2": 3 };
  const { scenario } = gyroscopeBenchOf({ device: { electrodes: { drive: {}, tuning: {} } } }, "C", both);
  expect(scenario).toMatchObject({ drive: { by: "volts" }, plant: { model: "tuned_gyroscope" } });
  // combs along one axis alone, or combs of the drawing alone, leave the drive by force
  const { "gyro.force_y_nn_per_v2": _, ...one } = both;
  for (const [electrodes, metrics] of [[{ drive: {} }, one] as const, [{}, both] as const]) {
    const plain = gyroscopeBenchOf({ device: { electrodes } }, "C", metrics).scenario;
    expect(plain).not.toHaveProperty("drive");
    expect(plain).not.toHaveProperty("plant");
  }
});

it("writes the field beyond the fingers as a word, and leaves it out for plates", () => {
  const state = withFringing(newDesign("lcr-350"), "free");
  expect(designDocument(state).device).toEqual({ id: "lcr-350", fringing: "free" });
  expect(designDocument(withFringing(state, "")).device).toEqual({ id: "lcr-350" });
});
