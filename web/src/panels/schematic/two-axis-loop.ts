import type { DrawnBox, Wire } from "./loop";

type Place = Pick<DrawnBox, "id" | "title" | "x" | "y">;

/** Above, the loop that makes x swing; in the middle what turns; below, the loop that reads the rate from y. */
export const TWO_AXES: readonly Place[] = [
  { id: "pick_x", title: "Pick-off x", x: 1, y: 2 },
  { id: "drive", title: "Drive controller", x: 118, y: 2 },
  { id: "force_x", title: "Force on x", x: 235, y: 2 },
  { id: "rate", title: "Angular rate", x: 1, y: 84 },
  { id: "plant", title: "Device", x: 118, y: 84 },
  { id: "pick_y", title: "Pick-off y", x: 1, y: 166 },
  { id: "sense", title: "Sense controller", x: 118, y: 166 },
  { id: "force_y", title: "Force on y", x: 235, y: 166 },
];

export const PARTNER: Place = { id: "partner", title: "Partner", x: 235, y: 84 };

export const TWO_AXIS_WIRES: readonly Wire[] = [
  { id: "x", d: "M150 84 V71 H53 V58", label: "x", at: [59, 69] },
  { id: "mx", d: "M105 30 H118", label: "", at: [0, 0] },
  { id: "ux", d: "M222 30 H235", label: "", at: [0, 0] },
  { id: "fx", d: "M287 58 V71 H190 V84", label: "F", at: [196, 82] },
  { id: "rate", d: "M105 112 H118", label: "Ω", at: [106, 106] },
  { id: "y", d: "M150 140 V153 H53 V166", label: "y", at: [59, 163] },
  { id: "my", d: "M105 194 H118", label: "", at: [0, 0] },
  { id: "uy", d: "M222 194 H235", label: "", at: [0, 0] },
  { id: "fy", d: "M287 166 V153 H190 V140", label: "F", at: [196, 151] },
];

/** The sense controller sees how the partner swings; some drive controllers make it swing as well. */
export const PARTNER_WIRES: readonly Wire[] = [{ id: "ps", d: "M235 126 H228 V180 H222", label: "", at: [0, 0] }];

export const PARTNER_DRIVEN: Wire = { id: "px", d: "M287 71 V84", label: "F", at: [293, 82] };

/** The boxes that show a fault. */
export const twoAxisBoxesOf = (shows: string | null | undefined): string[] => {
  if (shows === "sensor") return ["pick_x", "pick_y"];
  return shows === "drive" ? ["force_x"] : ["plant"];
};

/** Signals for the values in the boxes. */
export const twoAxisSignals = (drive: string, sense: string): Record<string, string> => ({
  pick_x: "sensor.x.displacement",
  drive: `${drive}.amplitude`,
  force_x: "drive.x.force",
  rate: "rate.rate",
  plant: "plant.angle",
  partner: "plant.partner_x",
  pick_y: "sensor.y.displacement",
  sense: `${sense}.rate`,
  force_y: "drive.y.force",
});
