import { LOOP, type LoopBox, WIRES, type Wire } from "./loop";

/** The parts of a bench that decide the drawing of its loop. */
export interface Parts {
  controller: string;
  /** Whether the error of direct MRAC is augmented. */
  augments: boolean;
  sensor: string;
  /** The light a counter of peaks and valleys looks at. */
  light: string;
  hasDiagnoser: boolean;
  hasIdentifier: boolean;
  /** Whether a supervisor changes the controller by the verdict of the diagnoser. */
  isSupervised: boolean;
}

/** A box of some structures only: its contents, and the signal for its value. */
interface ExtraBox extends Omit<LoopBox, "id"> {
  id: "adaptation" | "augmentation" | "estimator" | "gains" | "light" | "detector";
  kind: string;
  signal?: string;
  /** The block whose card it opens; the controller that drives unless given. */
  card?: string;
}

/** The drawing of the loop of a bench, after a figure of the dissertation with the same parts, if there is one. */
export interface Structure {
  figure?: string;
  boxes: readonly LoopBox[];
  extra: readonly ExtraBox[];
  wires: readonly Wire[];
  /** Whether the place below the device is free for the names of faults. */
  hasRoom: boolean;
}

const X_LETTER: [number, number] = [223, 130];
const UNDER_SENSOR = { x: 118, y: 166 };
const UNDER_DEVICE = { x: 235, y: 166 };

const MEASURED: Wire = { id: "zi", d: "M170 146 V166", label: "z", at: [176, 158] };
const ADAPTATION_WIRES: readonly Wire[] = [
  { id: "ym", d: "M105 194 H118", label: "yₘ", at: [105, 189] },
  { id: "theta", d: "M222 179 H228 V80 H190 V58", label: "θ", at: [197, 70] },
];
const AUGMENTATION_WIRES: readonly Wire[] = [
  { id: "omega", d: "M206 146 V155 H287 V166", label: "ω", at: [293, 162] },
  { id: "eta", d: "M235 206 H222", label: "η", at: [225, 201] },
];
const TUNING_WIRES: readonly Wire[] = [
  { id: "ui", d: "M232 30 V155 H139 V166", label: "u", at: [143, 162] },
  { id: "estimate", d: "M222 194 H235", label: "θ̂", at: [225, 189] },
  { id: "k", d: "M287 166 V160 H227 V80 H190 V58", label: "k", at: [197, 70] },
];
const LIGHT_WIRES: readonly Wire[] = [
  { id: "light", d: "M287 166 V146", label: "light", at: [293, 158] },
  { id: "intensity", d: "M235 134 H228 V194 H222", label: "I(x)", at: [206, 160] },
  { id: "signal", d: "M170 166 V146", label: "", at: [0, 0] },
];

/** Light by the unit that recovers a displacement from it: its kind, its detector, and the signal. */
type Light = [kind: string, detector: string, signal: string];
const LIGHTS: Record<string, Light | undefined> = {
  through_wafer: ["Through wafer", "Photodiode", "through_wafer.intensity"],
  dual_beam: ["Two beams", "Photodiodes", "dual_beam.first"],
  doppler: ["Doppler beam", "Vibrometer", "doppler.velocity"],
};
const lightOf = ({ sensor, light }: Parts): string | undefined =>
  ({ single_beam: "through_wafer", quadrature: "dual_beam", quadrature_kalman: "dual_beam", peak_valley: light })[
    sensor
  ];

const SELF_TUNING: Record<string, { figure: string; estimator: string } | undefined> = {
  indirect_mrac: { figure: "3.3.2.1", estimator: "Least squares" },
  stvsc: { figure: "2.2.3.1", estimator: "Gradient" },
};

const ACTS: Wire = {
  id: "acts",
  d: "M90 90 V82 H132 V58",
  label: "acts",
  at: [139, 70],
  acts: "The supervisor changes the controller by the verdict of the diagnosis",
};

const PLAIN: Structure = { boxes: LOOP, extra: [], wires: WIRES, hasRoom: true };
const OPTICAL_TITLES: Partial<Record<LoopBox["id"], string>> = { plant: "Device, grating", sensor: "Recovery unit" };

/** Return the drawing of the loop of a bench. An identifier of the bench takes the place of the additions of a figure. */
export function structureOf(parts: Parts): Structure {
  const structure = withoutSupervisor(parts);
  return parts.isSupervised && parts.hasDiagnoser ? { ...structure, wires: [...structure.wires, ACTS] } : structure;
}

function withoutSupervisor(parts: Parts): Structure {
  if (parts.hasIdentifier) return PLAIN;
  const light = LIGHTS[lightOf(parts) ?? ""];
  if (light) return optical(parts, light);
  const tuning = SELF_TUNING[parts.controller];
  if (tuning) return selfTuning(parts, tuning.figure, tuning.estimator);
  if (parts.controller === "mrac" || parts.controller === "mrac_velocity") return direct(parts);
  return PLAIN;
}

/** The boxes of the loop without an identifier, and without a missing diagnosis; the model has the input r. */
function around({ hasDiagnoser }: Parts): Pick<Structure, "boxes" | "wires"> {
  const gone = hasDiagnoser ? ["zi"] : ["zi", "ud", "zd"];
  return {
    boxes: LOOP.filter((box) => box.id !== "identifier" && (hasDiagnoser || box.id !== "diagnosis")),
    wires: [
      // the letter of x leaves room for a wire that passes the gap
      ...WIRES.filter((wire) => !gone.includes(wire.id)).map((w) => (w.id === "x" ? { ...w, at: X_LETTER } : w)),
      { id: "rm", d: hasDiagnoser ? "M82 58 V66 H112 V155 H53 V166" : "M53 58 V166", label: "r", at: [59, 162] },
    ],
  };
}

/** Light through the grating, its detector, and the unit that recovers the displacement. */
function optical(parts: Parts, [kind, detector, signal]: Light): Structure {
  const { boxes, wires } = around(parts);
  const seen = detector === "Vibrometer" ? "pulses" : "intensity";
  return {
    figure: "3.2.6.1",
    boxes: boxes.map((box) => ({ ...box, title: OPTICAL_TITLES[box.id] ?? box.title })),
    extra: [
      { id: "light", title: "Light", kind, ...UNDER_DEVICE, card: "sensor" },
      { id: "detector", title: detector, kind: seen, signal, ...UNDER_SENSOR, card: "sensor" },
    ],
    wires: [...wires.filter((wire) => wire.id !== "x"), ...LIGHT_WIRES],
    hasRoom: false,
  };
}

/** An identifier, and the design of the gains from its estimate. */
function selfTuning(parts: Parts, figure: string, estimator: string): Structure {
  const { boxes, wires } = around(parts);
  const signal = `${parts.controller}.prediction_error`;
  return {
    figure,
    boxes,
    extra: [
      { id: "estimator", title: "Identifier", kind: estimator, signal, ...UNDER_SENSOR },
      { id: "gains", title: "Gain design", kind: "k from θ̂", ...UNDER_DEVICE },
    ],
    wires: [...wires, MEASURED, ...TUNING_WIRES],
    hasRoom: false,
  };
}

/** Gains adapted by the error between device and model, which a plant that is not positive real needs augmented. */
function direct(parts: Parts): Structure {
  const { boxes, wires } = around(parts);
  const plain = { boxes, wires: [...wires, MEASURED, ...ADAPTATION_WIRES] };
  const adaptation = { id: "adaptation", title: "Adaptation", ...UNDER_SENSOR } as const;
  if (parts.controller === "mrac_velocity" || !parts.augments) {
    const by = { ...adaptation, kind: "gains, by e", signal: `${parts.controller}.error` };
    return { ...plain, figure: "2.2.1", extra: [by], hasRoom: true };
  }
  return {
    figure: "3.1.2.1.1",
    boxes,
    extra: [
      { ...adaptation, kind: "gains, by ε", signal: "mrac.augmented_error" },
      { id: "augmentation", title: "Augmentation", kind: "error η", signal: "mrac.auxiliary_error", ...UNDER_DEVICE },
    ],
    wires: [...plain.wires, ...AUGMENTATION_WIRES],
    hasRoom: false,
  };
}
