import type { Knob, KnobGroup } from "../ui/surroundings";

const um = (name: string, label: string, low: number, high: number, step: number): Knob => ({
  path: `geometry.${name}`,
  label,
  unit: "um",
  low,
  high,
  step,
});

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
      { path: "geometry.fingers", label: "Fingers per side", unit: "", low: 4, high: 160, step: 1 },
      um("finger_gap_um", "Gap, drawn", 0.5, 6, 0.05),
      um("finger_width_um", "Finger width, drawn", 1, 6, 0.05),
      um("comb_bias_um", "Etch bias per edge", 0, 0.45, 0.005),
      um("finger_length_um", "Finger length", 20, 150, 1),
      um("overlap_um", "Overlap at rest", 5, 100, 1),
      { path: "bias_v", label: "Bias", unit: "V", low: 1, high: 60, step: 0.5 },
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
      { path: "geometry.youngs_modulus_gpa", label: "Young's modulus", unit: "GPa", low: 100, high: 200, step: 0.5 },
      { path: "geometry.density_kg_m3", label: "Density", unit: "kg/m^3", low: 1500, high: 8000, step: 10 },
    ],
  },
];

/** The knobs of a device that is given by its figures. */
export function given(value: (path: string) => number | undefined): KnobGroup[] {
  const around = (path: string, label: string, unit: string): Knob[] => {
    const middle = value(path);
    return middle === undefined ? [] : [{ path, label, unit, low: middle / 4, high: middle * 4, step: 0, log: true }];
  };
  return [
    {
      title: "Given by figures",
      knobs: [
        ...around("mass_kg", "Mass", "kg"),
        ...around("stiffness_n_m", "Stiffness", "N/m"),
        ...around("damping_ns_m", "Damping", "N s/m"),
        ...around("force_n_per_v", "Force per volt", "N/V"),
        ...(value("fingers") === undefined
          ? []
          : [{ path: "fingers", label: "Fingers per side", unit: "", low: 4, high: 160, step: 1 }]),
        { path: "bias_v", label: "Bias", unit: "V", low: 1, high: 60, step: 0.5 },
      ],
    },
  ];
}
