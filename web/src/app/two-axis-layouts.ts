import type { DockviewApi } from "dockview-react";
import { scopeConfig } from "../stream/scope-config";
import { addTo, type Layouts, LIST_PX, LOOP_PX, size, THREE_COLUMNS_PX } from "./built-in-layouts";

const RATE = scopeConfig(["rate.rate", "@active.rate"], { windowMs: 500 });
const MOTION = scopeConfig(["plant.x", "plant.y"], { windowMs: 2 });
const FORCES = scopeConfig(["drive.x.force", "drive.y.force"], { windowMs: 2 });
const QUADRATURE = scopeConfig(["@active.quadrature"], { windowMs: 500 });

/** Below the rate: the path of the mass, and the forces that move it. */
function addBelow(api: DockviewApi, beside: boolean): void {
  addTo(api, "forces", "time", { below: "rate" }, FORCES, "Forces");
  addTo(api, "locus", "locus", beside ? { right: "forces" } : { within: "forces", inactive: true });
  addTo(api, "motion", "time", { within: "forces", inactive: true }, MOTION, "Motion along x and y");
  addTo(api, "quadrature", "time", { within: "forces", inactive: true }, QUADRATURE, "Quadrature");
  for (const view of ["lanes", "allan"] as const) addTo(api, view, view, { within: "rate", inactive: true });
  for (const view of ["twins", "claims"] as const) addTo(api, view, view, { within: "forces", inactive: true });
}

/** The same layouts for a device with axes, which has a rate. */
export const BUILT_IN_AXES: Layouts = {
  lecture(api, width, height) {
    const wide = width >= THREE_COLUMNS_PX;
    addTo(api, "rate", "time", {}, RATE, "Angular rate");
    addTo(api, "controllers", "controllers", { right: "rate" });
    addTo(api, "faults", "faults", { within: "controllers", inactive: true });
    addTo(api, "lanes", "lanes", { within: "rate", inactive: true });
    addTo(api, "locus", "locus", { below: "rate" });
    addTo(api, "view3d", "view3d", wide ? { right: "locus" } : { within: "locus", inactive: true });
    const list = Math.max(0.36, LIST_PX / width);
    size(api, width, height, { controllers: { w: list }, locus: { h: 0.52 } });
    if (wide) size(api, width, height, { locus: { w: 0.32 } });
  },
  lab(api, width, height) {
    addTo(api, "rate", "time", {}, RATE, "Angular rate");
    addTo(api, "schematic", "schematic", { left: "rate" });
    addTo(api, "controllers", "controllers", { below: "schematic" });
    for (const view of ["faults", "device"] as const) addTo(api, view, view, { within: "controllers", inactive: true });
    const wide = width >= THREE_COLUMNS_PX;
    addBelow(api, wide);
    for (const view of ["sheet", "why", "narrator"] as const)
      addTo(api, view, view, { within: "forces", inactive: true });
    const loops = Math.max(0.28, LOOP_PX.width / width);
    size(api, width, height, {
      schematic: { w: loops, h: Math.max(0.4, LOOP_PX.height / height) },
      rate: { h: 0.48 },
      ...(wide ? { forces: { w: 0.58 * (1 - loops) } } : {}),
    });
  },
  research(api, width, height) {
    const wide = width >= THREE_COLUMNS_PX;
    addTo(api, "rate", "time", {}, RATE, "Angular rate");
    addTo(api, "schematic", "schematic", { left: "rate" });
    addTo(api, "controllers", "controllers", { below: "schematic" });
    for (const view of ["faults", "device"] as const) addTo(api, view, view, { within: "controllers", inactive: true });
    addTo(api, "view3d", "view3d", wide ? { right: "rate" } : { within: "schematic", inactive: true });
    addTo(api, "why", "why", wide ? { below: "view3d" } : { within: "controllers", inactive: true });
    addTo(api, "narrator", "narrator", { within: "why", inactive: true });
    addBelow(api, wide);
    size(api, width, height, {
      schematic: { w: Math.max(0.25, LOOP_PX.width / width), h: Math.max(0.36, LOOP_PX.height / height) },
      ...(wide ? { view3d: { w: 0.25, h: 0.4 }, forces: { w: 0.27 } } : {}),
      rate: { h: 0.48 },
    });
  },
};
