import type { UnstableRegion } from "../../api/types";
import { formatShort, formatSi } from "../../ui/format";
import type { Range } from "./phase-range";

const DISPLACEMENTS = ["plant.displacement", "sensor.displacement", "model.displacement"];

/** The parts of the map of the unstable region for two signals: folds need the travel, the boundary its speed too. */
export function mapFits(x: string, y: string): { folds: boolean; boundary: boolean } {
  const folds = DISPLACEMENTS.includes(x);
  return { folds, boundary: folds && y === "plant.velocity" };
}

/** The range of the map on an axis: the boundary if it has one, else the folds. */
export function mapExtent(map: UnstableRegion | undefined, axis: "x" | "y"): Range | undefined {
  if (!map) return undefined;
  if (map.boundary) {
    const values = axis === "x" ? map.boundary.x_um : map.boundary.speed_um_ms;
    const most = Math.max(...values.map(Math.abs));
    return axis === "y" ? [-most * 1.15, most * 1.15] : [Math.min(...values) * 1.1, Math.max(...values) * 1.1];
  }
  if (axis === "y" || map.folds.length === 0) return undefined;
  const places = map.folds.map((f) => f.x_um);
  return [Math.min(...places, 0) * 1.15, Math.max(...places, 0) * 1.15];
}

/** The map in words, or why it is empty. */
export function mapWords(map: UnstableRegion): string {
  if (map.folds.some((f) => f.x_um === 0)) return "The rest position is unstable: lower the bias.";
  const fold = map.folds[0];
  const text = fold
    ? `Dashed: a slow drive folds at ${formatSi(Math.abs(fold.x_um), "um", 3)} and ${formatSi(Math.abs(fold.volts), "V", 3)}.`
    : "";
  if (map.boundary) return `${text} Shaded: the energy suffices to pull in.`.trim();
  if (fold)
    return `${text} Shaded: beyond it. With the drive held at ${formatShort(map.drive_v, "V")} nothing within the travel pulls in.`;
  if (map.plant === "planar" || map.plant === "slaved_lateral") return "Nothing within the travel pulls in.";
  return "";
}
