import type { Knob, KnobGroup } from "../ui/surroundings";

export const knob = (path: string, label: string, unit: string, low: number, high: number, step: number): Knob => ({
  path,
  label,
  unit,
  low,
  high,
  step,
});
const um = (name: string, label: string, low: number, high: number, step: number) =>
  knob(`geometry.${name}`, label, "um", low, high, step);
const fingers = (path: string) => knob(path, "Fingers per side", "", 4, 160, 1);
const BIAS = knob("bias_v", "Bias", "V", 1, 60, 0.5);

/** A knob around a given value, by ratios; none without the value. */
export const around = (path: string, label: string, unit: string, middle: number | undefined): Knob[] =>
  middle ? [{ ...knob(path, label, unit, middle / 4, middle * 4, 0), log: true }] : [];

/** The knobs of a drawing with their usual ranges; exact entry goes further. */
export const DRAWING: KnobGroup[] = [
  {
    title: "Beams and trusses",
    knobs: [
      um("beam_length_um", "Beam length", 100, 800, 1),
      um("beam_width_um", "Beam width, drawn", 1, 6, 0.05),
      um("beam_bias_um", "Etch bias per edge", 0, 0.45, 0.005),
      um("truss_width_um", "Truss width, drawn", 1, 16, 0.1),
      um("truss_segment_um", "Truss between beams", 10, 80, 1),
    ],
  },
  {
    title: "Comb",
    knobs: [
      fingers("geometry.fingers"),
      um("finger_gap_um", "Gap, drawn", 0.5, 6, 0.05),
      um("finger_width_um", "Finger width, drawn", 1, 6, 0.05),
      um("comb_bias_um", "Etch bias per edge", 0, 0.45, 0.005),
      um("finger_length_um", "Finger length", 20, 150, 1),
      um("overlap_um", "Overlap at rest", 5, 100, 1),
      BIAS,
    ],
  },
  {
    title: "Layers and plate",
    knobs: [
      um("thickness_um", "Structural thickness", 0.5, 10, 0.05),
      um("film_gap_um", "Gas film under it", 0.5, 6, 0.05),
      um("plate_length_um", "Plate length", 120, 500, 5),
      um("plate_width_um", "Plate width", 40, 300, 5),
      um("arm_width_um", "Arm width", 4, 30, 0.5),
      um("arm_length_um", "Arm length", 100, 1200, 10),
      knob("geometry.youngs_modulus_gpa", "Young's modulus", "GPa", 100, 200, 0.5),
      knob("geometry.density_kg_m3", "Density", "kg/m^3", 1500, 8000, 10),
    ],
  },
];

/** The knobs of a device that is given by its figures. */
export const given = (value: (path: string) => number | undefined): KnobGroup[] => [
  {
    title: "Given by figures",
    knobs: [
      ...around("mass_kg", "Mass", "kg", value("mass_kg")),
      ...around("stiffness_n_m", "Stiffness", "N/m", value("stiffness_n_m")),
      ...around("damping_ns_m", "Damping", "N s/m", value("damping_ns_m")),
      ...around("force_n_per_v", "Force per volt", "N/V", value("force_n_per_v")),
      ...(value("fingers") === undefined ? [] : [fingers("fingers")]),
      BIAS,
    ],
  },
];
