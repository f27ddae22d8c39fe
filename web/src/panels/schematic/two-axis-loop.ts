import type { DrawnBox, Wire } from "./loop";

type Place = Pick<DrawnBox, "id" | "title" | "x" | "y">;

/** Above, the loop that makes x swing; in the middle what turns; below, the loop that reads the rate from y. */
export const TWO_AXES: readonly Place[] = [
  { id: "pick_x", title: "Pick-off x", x: 1, y: 2 },
  { id: "drive", title: "Drive controller", x: 119, y: 2 },
  { id: "force_x", title: "Force on x", x: 237, y: 2 },
  { id: "rate", title: "Angular rate", x: 1, y: 100 },
  { id: "plant", title: "Device", x: 119, y: 100 },
  { id: "pick_y", title: "Pick-off y", x: 1, y: 198 },
  { id: "sense", title: "Sense controller", x: 119, y: 198 },
  { id: "force_y", title: "Force on y", x: 237, y: 198 },
];

export const PARTNER: Place = { id: "partner", title: "Partner", x: 237, y: 100 };

export const TWO_AXIS_WIRES: readonly Wire[] = [
  { id: "x", d: "M150 100 V84 H52 V68", label: "x", at: [58, 80] },
  { id: "mx", d: "M103 35 H119", label: "", at: [0, 0] },
  { id: "ux", d: "M221 35 H237", label: "", at: [0, 0] },
  { id: "fx", d: "M288 68 V84 H190 V100", label: "F", at: [196, 98] },
  { id: "rate", d: "M103 133 H119", label: "Ω", at: [106, 127] },
  { id: "y", d: "M150 166 V182 H52 V198", label: "y", at: [58, 194] },
  { id: "my", d: "M103 231 H119", label: "", at: [0, 0] },
  { id: "uy", d: "M221 231 H237", label: "", at: [0, 0] },
  { id: "fy", d: "M288 198 V182 H190 V166", label: "F", at: [196, 178] },
];

/** The sense controller sees how the partner swings; some drive controllers make it swing as well. */
export const PARTNER_WIRES: readonly Wire[] = [{ id: "ps", d: "M237 150 H229 V214 H221", label: "", at: [0, 0] }];

export const PARTNER_DRIVEN: Wire = { id: "px", d: "M288 84 V100", label: "F", at: [294, 97] };

/** The boxes on which a fault is seen. */
export const twoAxisBoxesOf = (shows: string | null | undefined): string[] => {
  if (shows === "sensor") return ["pick_x", "pick_y"];
  return shows === "drive" ? ["force_x"] : ["plant"];
};

/** Signals whose values stand in the boxes. */
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
