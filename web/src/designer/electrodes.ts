import type { Knob } from "../ui/surroundings";
import { knob } from "./knobs";

/** An electrode that a gyroscope may have: its table below `device`, its knobs, and the numbers to begin with. */
export interface Electrode {
  table: string;
  title: string;
  knobs: Knob[];
  first: Record<string, number>;
}

/** Thick fingers with narrow gaps, as the tuning plates have them: a device by its numbers has no drawing. */
const COMB = { bias_v: 10, fingers: 100, thickness_um: 60, gap_um: 3 };
const PLATES = { plates: 20, length_um: 400, thickness_um: 60, gap_um: 3 };

const sizes = (table: string): Knob[] => [
  knob(`${table}.thickness_um`, "Structural thickness", "um", 1, 200, 1),
  knob(`${table}.gap_um`, "Gap, as etched", "um", 0.5, 10, 0.1),
];
const comb = (name: string, title: string): Electrode => {
  const table = `electrodes.${name}`;
  const own = [
    knob(`${table}.bias_v`, "Bias", "V", 1, 60, 0.5),
    knob(`${table}.fingers`, "Fingers per side", "", 4, 1000, 1),
  ];
  return { table, title, first: COMB, knobs: [...own, ...sizes(table)] };
};

/** The plates that soften the spring along y. */
export const TUNING: Electrode = {
  table: "electrodes.tuning",
  title: "Tuning electrode",
  first: PLATES,
  knobs: [
    knob("electrodes.tuning.plates", "Plates on each side", "", 1, 200, 1),
    knob("electrodes.tuning.length_um", "Length of a plate", "um", 20, 1000, 5),
    ...sizes("electrodes.tuning"),
  ],
};

/** The combs that push and pull along an axis; a drawing has its own. */
export const COMBS: Electrode[] = [comb("drive", "Combs along x"), comb("sense", "Combs along y")];
