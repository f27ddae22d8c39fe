import type { DockviewApi } from "dockview-react";
import { scopeConfig } from "../stream/scope-config";
import { addBehind, addTo, type Layouts, LIST_PX, LOOP_PX, size, THREE_COLUMNS_PX } from "./built-in-layouts";

const RATE = scopeConfig(["rate.rate", "@active.rate"], { windowMs: 500 });
const MOTION = scopeConfig(["plant.x", "plant.y"], { windowMs: 2 });
const FORCES = scopeConfig(["drive.x.force", "drive.y.force"], { windowMs: 2 });
const QUADRATURE = scopeConfig(["@active.quadrature"], { windowMs: 500 });

/** Below the rate the forces that move the mass; and its path, where it has a place of its own. */
function addBelow(api: DockviewApi, path?: { right: "forces" } | { below: "view3d" }): void {
  addTo(api, "forces", "time", { below: "rate" }, FORCES, "Forces");
  addTo(api, "locus", "locus", path ?? { within: "forces", inactive: true });
  addBehind(api, "rate", path ? ["lanes", "allan"] : ["lanes"]);
  if (!path) return;
  addTo(api, "motion", "time", { within: "forces", inactive: true }, MOTION, "Motion x, y");
  addTo(api, "quadrature", "time", { within: "rate", inactive: true }, QUADRATURE, "Quadrature");
}

/** The same layouts for a device with axes, which has a rate. */
export const BUILT_IN_AXES: Layouts = {
  lecture(api, width, height) {
    const wide = width >= THREE_COLUMNS_PX;
    addTo(api, "rate", "time", {}, RATE, "Angular rate");
    addTo(api, "controllers", "controllers", { right: "rate" });
    addBehind(api, "rate", ["lanes"]);
    addTo(api, "locus", "locus", { below: "rate" });
    addBehind(api, wide ? "controllers" : "locus", ["faults"]);
    addTo(api, "view3d", "view3d", wide ? { right: "locus" } : { within: "locus", inactive: true });
    const list = Math.max(0.36, LIST_PX / width);
    size(api, width, height, { controllers: { w: list }, locus: { h: 0.44 } });
    if (wide) size(api, width, height, { locus: { w: 0.32 } });
  },
  lab(api, width, height) {
    addTo(api, "rate", "time", {}, RATE, "Angular rate");
    addTo(api, "schematic", "schematic", { left: "rate" });
    addTo(api, "controllers", "controllers", { below: "schematic" });
    const wide = width >= THREE_COLUMNS_PX;
    addBehind(api, "controllers", ["faults"]);
    addBehind(api, "schematic", ["device"]);
    addBelow(api, wide ? { right: "forces" } : undefined);
    addBehind(api, wide ? "rate" : "forces", ["sheet"]);
    if (wide) {
      addBehind(api, "rate", ["why", "narrator", "claims"]);
      addBehind(api, "locus", ["twins"]);
    }
    const loops = Math.max(0.28, LOOP_PX.width / width);
    size(api, width, height, {
      schematic: { w: loops, h: Math.max(0.4, LOOP_PX.height / height) },
      rate: { h: 0.5 },
      ...(wide ? { forces: { w: 0.65 * (1 - loops) } } : {}),
    });
  },
  research(api, width, height) {
    const wide = width >= THREE_COLUMNS_PX;
    addTo(api, "rate", "time", {}, RATE, "Angular rate");
    addTo(api, "schematic", "schematic", { left: "rate" });
    addTo(api, "controllers", "controllers", { below: "schematic" });
    addBehind(api, "controllers", ["faults"]);
    addTo(api, "view3d", "view3d", wide ? { right: "rate" } : { within: "schematic", inactive: true });
    addBelow(api, wide ? { below: "view3d" } : undefined);
    addBehind(api, wide ? "schematic" : "forces", ["device"]);
    if (wide) {
      addBehind(api, "locus", ["why", "narrator"]);
      addBehind(api, "view3d", ["twins", "claims"]);
    }
    size(api, width, height, {
      schematic: { w: Math.max(0.25, LOOP_PX.width / width), h: Math.max(0.36, LOOP_PX.height / height) },
      ...(wide ? { view3d: { w: 0.25, h: 0.4 } } : {}),
      rate: { h: 0.5 },
    });
  },
};
