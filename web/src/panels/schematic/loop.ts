/** A box of the loop: its place on the drawing. */
export interface LoopBox {
  id: "reference" | "controller" | "drive" | "plant" | "sensor" | "diagnosis" | "model" | "identifier";
  title: string;
  x: number;
  y: number;
}

/**
 * The loop, drawn once round: reference, controller, drive above; device, sensor, diagnosis below; under them the
 * reference model and the identifier.
 */
export const LOOP: LoopBox[] = [
  { id: "reference", title: "Reference", x: 1, y: 2 },
  { id: "controller", title: "Controller", x: 118, y: 2 },
  { id: "drive", title: "Drive", x: 235, y: 2 },
  { id: "plant", title: "Device", x: 235, y: 90 },
  { id: "sensor", title: "Sensor", x: 118, y: 90 },
  { id: "diagnosis", title: "Diagnosis", x: 1, y: 90 },
  { id: "model", title: "Reference model", x: 1, y: 166 },
  { id: "identifier", title: "Identifier", x: 118, y: 166 },
];

/** From the names of faults to their box. */
export const FAULT_ARROWS: Record<FaultedBox, string> = {
  plant: "M287 166 V148",
  sensor: "M281 158 H204 V148",
  drive: "M293 158 H344 V30 H341",
};

type FaultedBox = "plant" | "sensor" | "drive";

/** The box that shows a fault; every part except sensor and drive belongs to the device. */
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
  { id: "r", d: "M105 30 H118", label: "r", at: [108, 24] },
  { id: "u", d: "M222 30 H235", label: "u", at: [224, 24] },
  { id: "v", d: "M287 58 V90", label: "V", at: [293, 78] },
  { id: "x", d: "M235 118 H222", label: "x", at: [225, 112] },
  { id: "z", d: "M170 90 V58", label: "z", at: [176, 87] },
  { id: "zd", d: "M118 124 H105", label: "z", at: [108, 118] },
  { id: "zi", d: "M170 146 V166", label: "z", at: [176, 160] },
  { id: "ud", d: "M228 30 V73 H53 V90", label: "u", at: [59, 87] },
];

/** A box of a loop as drawn. */
export interface DrawnBox {
  id: string;
  title: string;
  x: number;
  y: number;
  /** Its contents now. */
  kind: string;
  /** The card it opens. */
  card: string | undefined;
  /** A value in words, where no signal tells it. */
  says?: string;
  faulty: boolean;
  /** A stage of the board there that acts: a mark, and words. */
  stage?: { mark: string; words: string };
  /** Another controller does its work. */
  waits?: boolean;
}

/** A signal path between boxes. */
export interface Wire {
  id: string;
  d: string;
  label: string;
  at: [number, number];
  /** The meaning of a path without a signal, along which a supervisor acts. */
  acts?: string;
}

/** Letters are drawn at least at 0.88 of their size: below that the drawing scrolls. */
export const DRAWING = { width: 348, height: 226 };

export const BOX = { width: 104, height: 56 };
