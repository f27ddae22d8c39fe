/** A box of the loop: its place on the drawing. */
export interface LoopBox {
  id: "reference" | "controller" | "drive" | "plant" | "sensor" | "diagnosis" | "model" | "identifier";
  title: string;
  x: number;
  y: number;
}

/**
 * The loop, drawn once round: reference, controller, drive above; device, sensor, diagnosis below; under them what
 * the controllers compare with and what identifies the device.
 */
export const LOOP: LoopBox[] = [
  { id: "reference", title: "Reference", x: 1, y: 2 },
  { id: "controller", title: "Controller", x: 119, y: 2 },
  { id: "drive", title: "Drive", x: 237, y: 2 },
  { id: "plant", title: "Device", x: 237, y: 108 },
  { id: "sensor", title: "Sensor", x: 119, y: 108 },
  { id: "diagnosis", title: "Diagnosis", x: 1, y: 108 },
  { id: "model", title: "Reference model", x: 1, y: 198 },
  { id: "identifier", title: "Identifier", x: 119, y: 198 },
];

/** From the names of faults to the box on which they act. */
export const FAULT_ARROWS: Record<FaultedBox, string> = {
  plant: "M288 198 V176",
  sensor: "M282 190 H205 V176",
  drive: "M294 190 H345 V35 H341",
};

export type FaultedBox = "plant" | "sensor" | "drive";

/** The box on which a fault is seen; all parts but sensor and drive belong to the device. */
export const boxOf = (shows: string | null | undefined): FaultedBox =>
  shows === "sensor" || shows === "drive" ? shows : "plant";

const MOST_NAMES = 4;

/** Names of faults as lines with room for them: the first few, and how many more. */
export function faultLines(titles: readonly string[]): string[] {
  if (titles.length <= MOST_NAMES) return [...titles];
  return [...titles.slice(0, MOST_NAMES - 1), `and ${titles.length - MOST_NAMES + 1} more`];
}

/** Signal paths between the boxes. */
export const WIRES: readonly Wire[] = [
  { id: "r", d: "M103 35 H119", label: "r", at: [108, 29] },
  { id: "u", d: "M221 35 H237", label: "u", at: [225, 29] },
  { id: "v", d: "M288 68 V108", label: "V", at: [294, 92] },
  { id: "x", d: "M237 141 H221", label: "x", at: [226, 135] },
  { id: "z", d: "M170 108 V68", label: "z", at: [176, 104] },
  { id: "zd", d: "M119 148 H103", label: "z", at: [108, 142] },
  { id: "zi", d: "M170 174 V198", label: "z", at: [176, 190] },
  { id: "ud", d: "M228 35 V86 H52 V108", label: "u", at: [58, 104] },
];

/** A box of a loop as drawn. */
export interface DrawnBox {
  id: string;
  title: string;
  x: number;
  y: number;
  /** What stands in it now. */
  kind: string;
  /** The card it opens. */
  card: string | undefined;
  /** A value in words, where no signal tells it. */
  says?: string;
  faulty: boolean;
  /** Something else does its work. */
  waits?: boolean;
}

/** A signal path between boxes. */
export interface Wire {
  id: string;
  d: string;
  label: string;
  at: [number, number];
}

export const BOX = { width: 102, height: 66 };
