import type { Knob, KnobGroup } from "../ui/surroundings";
import { roundTo } from "../ui/unit-scale";
import { around, DRAWING, knob } from "./knobs";

/** The range of a cross term, as a share of the smaller term that it couples; it must stay below 1. */
const CROSS_SHARE = 0.2;
const MOST_DEG = 10;

/** The knobs of a gyroscope: its masses and swing, its stiffness and damping with their cross terms. */
export function gyroscopeKnobs(value: (path: string) => number | undefined): KnobGroup[] {
  const at = (name: string) => value(`gyroscope.${name}`);
  const about = (name: string, label: string, unit: string): Knob[] =>
    around(`gyroscope.${name}`, label, unit, at(name));
  const within = (name: string, label: string, unit: string, reach: number): Knob[] =>
    at(name) === undefined ? [] : [knob(`gyroscope.${name}`, label, unit, -reach, reach, roundTo(reach / 200, 1))];
  const cross = (x: string, y: string) => roundTo(CROSS_SHARE * Math.min(at(x) ?? 1, at(y) ?? 1), 1);
  return [
    {
      title: "Masses and swing",
      knobs: [
        ...about("mass_x_kg", "Mass along x", "kg"),
        ...about("mass_y_kg", "Mass along y", "kg"),
        ...about("coriolis_mass_kg", "Mass the rate acts on", "kg"),
        ...about("drive_amplitude_um", "Amplitude of x", "um"),
      ],
    },
    {
      title: "Stiffness",
      knobs: [
        ...about("stiffness_x_n_m", "Along x", "N/m"),
        ...about("stiffness_y_n_m", "Along y", "N/m"),
        ...within("stiffness_xy_n_m", "Cross stiffness", "N/m", cross("stiffness_x_n_m", "stiffness_y_n_m")),
        ...within("alpha_deg", "Angle of its axes", "deg", MOST_DEG),
      ],
    },
    {
      title: "Damping",
      knobs: [
        ...about("damping_x_ns_m", "Along x", "N s/m"),
        ...about("damping_y_ns_m", "Along y", "N s/m"),
        ...within("damping_xy_ns_m", "Cross damping", "N s/m", cross("damping_x_ns_m", "damping_y_ns_m")),
        ...within("gamma_deg", "Angle of its axes", "deg", MOST_DEG),
      ],
    },
  ];
}

const drawn = (name: string, label: string, unit: string, low: number, high: number, step: number) =>
  knob(`drawn_gyroscope.${name}`, label, unit, low, high, step);

/** The knobs of a gyroscope from a drawing: the drawing, the sense frame, and the numbers outside a drawing. */
export const DRAWN_GYROSCOPE: KnobGroup[] = [
  {
    title: "Sense frame, along y",
    knobs: [
      drawn("sense_beam_length_um", "Beam length along y", "um", 100, 800, 1),
      drawn("sense_beam_width_um", "Beam width along y, drawn", "um", 1, 6, 0.05),
      drawn("sense_fingers", "Fingers per side along y", "", 4, 160, 1),
    ],
  },
  ...DRAWING.map(({ title, knobs }) => ({
    title,
    knobs: knobs
      .filter(({ path }) => path !== "bias_v")
      .map((knob) => ({ ...knob, label: knob.label.replace(/^(Beam \w+|Fingers per side)/, "$1 along x") })),
  })),
  {
    title: "Combs by volts",
    knobs: [
      knob("electrodes.drive.bias_v", "Bias along x", "V", 1, 60, 0.5),
      knob("electrodes.sense.bias_v", "Bias along y", "V", 1, 60, 0.5),
    ],
  },
  {
    title: "Swing, package and making",
    knobs: [
      drawn("drive_amplitude_um", "Amplitude of x", "um", 0.5, 15, 0.1),
      { ...drawn("package_pa", "Pressure in the package", "Pa", 0.1, 1e5, 0), log: true },
      drawn("alpha_deg", "Angle of the axes of stiffness", "deg", -2, 2, 0.01),
      drawn("gamma_deg", "Angle of the axes of damping", "deg", -2, 2, 0.01),
    ],
  },
];
