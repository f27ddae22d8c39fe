import type { AddPanelOptions, DockviewApi } from "dockview-react";
import type { LayoutName } from "../bench/view-store";
import { type ScopeConfig, scopeConfig } from "../stream/scope-config";

const MOTION = scopeConfig(["plant.displacement", "sensor.displacement", "model.displacement"]);
const TRACKING = scopeConfig(["model.tracking_error"]);
const VOLTAGE = scopeConfig(["reference.voltage", "drive.voltage"]);

/** The loop is drawn no smaller than this; what stands below it is as wide. */
export const LOOP_PX = { width: 326, height: 312 };

/** A column of faults or controllers is read at this width. */
export const LIST_PX = 310;

/** In less than this a third column has no room; its panels stand behind others. */
export const THREE_COLUMNS_PX = 1000;

interface Where {
  below?: string;
  right?: string;
  left?: string;
  within?: string;
  inactive?: boolean;
}

export function addTo(
  api: DockviewApi,
  id: string,
  kind: string,
  where: Where = {},
  scope?: ScopeConfig,
  title?: string,
): void {
  const direction = where.below
    ? "below"
    : where.right
      ? "right"
      : where.left
        ? "left"
        : where.within
          ? "within"
          : undefined;
  const referencePanel = where.below ?? where.right ?? where.left ?? where.within;
  const options = {
    id,
    component: kind,
    ...(title ? { title } : {}),
    params: scope ? { scope } : {},
    inactive: where.inactive ?? false,
    ...(direction && referencePanel ? { position: { direction, referencePanel } } : {}),
  };
  api.addPanel(options as AddPanelOptions);
}

/** Set the heights and widths of panels, as shares of the page. */
export function size(
  api: DockviewApi,
  width: number,
  height: number,
  shares: Record<string, { w?: number; h?: number }>,
): void {
  for (const [id, { w, h }] of Object.entries(shares))
    api.getPanel(id)?.api.setSize({ ...(w ? { width: w * width } : {}), ...(h ? { height: h * height } : {}) });
}

/** Where the shuttle is and should be; how far it is away stands behind. */
function addMotion(api: DockviewApi): void {
  addTo(api, "motion", "scope", {}, MOTION, "Displacement");
  addTo(api, "tracking", "scope", { within: "motion", inactive: true }, TRACKING, "Tracking error");
}

/** The layouts everybody has; sizes are shares of the page. */
export type Layouts = Record<LayoutName, (api: DockviewApi, width: number, height: number) => void>;

/** Those of a device with one displacement. */
export const BUILT_IN: Layouts = {
  lecture(api, width, height) {
    addMotion(api);
    addTo(api, "faults", "faults", { right: "motion" });
    addTo(api, "view3d", "view3d", { below: "faults" });
    addTo(api, "why", "why", { within: "view3d", inactive: true });
    addTo(api, "lanes", "lanes", { below: "motion" });
    addTo(api, "claims", "claims", { within: "lanes", inactive: true });
    size(api, width, height, { faults: { w: Math.max(0.3, LIST_PX / width), h: 0.42 }, lanes: { h: 0.55 } });
  },
  lab(api, width, height) {
    addMotion(api);
    addTo(api, "schematic", "schematic", { left: "motion" });
    addTo(api, "faults", "faults", { below: "schematic" });
    addTo(api, "environment", "environment", { within: "faults", inactive: true });
    addTo(api, "card", "card", { within: "faults", inactive: true });
    addTo(api, "why", "why", { within: "faults", inactive: true });
    addTo(api, "labs", "labs", { within: "faults", inactive: true });
    addTo(api, "blind", "blind", { within: "faults", inactive: true });
    addTo(api, "games", "games", { within: "faults", inactive: true });
    addTo(api, "voltage", "scope", { below: "motion" }, VOLTAGE, "Voltage");
    addTo(api, "lanes", "lanes", { below: "voltage" });
    addTo(api, "sheet", "sheet", { within: "lanes", inactive: true });
    addTo(api, "events", "events", { within: "lanes", inactive: true });
    addTo(api, "narrator", "narrator", { within: "lanes", inactive: true });
    addTo(api, "claims", "claims", { within: "lanes", inactive: true });
    addTo(api, "adaptation", "adaptation", { within: "lanes", inactive: true });
    addTo(api, "twins", "twins", { within: "lanes", inactive: true });
    addTo(api, "hypotheses", "hypotheses", { within: "lanes", inactive: true });
    addTo(api, "behaviour", "behaviour", { within: "lanes", inactive: true });
    addTo(api, "phase", "phase", { within: "lanes", inactive: true });
    addTo(api, "spectrum", "spectrum", { within: "lanes", inactive: true });
    addTo(api, "identify", "identify", { within: "lanes", inactive: true });
    addTo(api, "recordings", "recordings", { within: "lanes", inactive: true });
    size(api, width, height, {
      schematic: { w: Math.max(0.26, LOOP_PX.width / width), h: Math.max(0.34, LOOP_PX.height / height) },
      motion: { h: 0.31 },
      voltage: { h: 0.3 },
      lanes: { h: 0.39 },
    });
  },
  research(api, width, height) {
    const wide = width >= THREE_COLUMNS_PX;
    addMotion(api);
    addTo(api, "schematic", "schematic", { left: "motion" });
    addTo(api, "faults", "faults", { below: "schematic" });
    addTo(api, "view3d", "view3d", wide ? { right: "motion" } : { within: "schematic", inactive: true });
    addTo(api, "card", "card", wide ? { below: "view3d" } : { within: "faults", inactive: true });
    addTo(api, "why", "why", { within: "card", inactive: true });
    addTo(api, "scores", "scores", { within: "card", inactive: true });
    addTo(api, "events", "events", { within: "card", inactive: true });
    addTo(api, "narrator", "narrator", { within: "card", inactive: true });
    addTo(api, "environment", "environment", { within: "faults", inactive: true });
    addTo(api, "labs", "labs", { within: "faults", inactive: true });
    addTo(api, "blind", "blind", { within: "faults", inactive: true });
    addTo(api, "games", "games", { within: "faults", inactive: true });
    addTo(api, "voltage", "scope", { below: "motion" }, VOLTAGE, "Voltage");
    addTo(api, "lanes", "lanes", { below: "voltage" });
    addTo(api, "claims", "claims", { within: "lanes", inactive: true });
    addTo(api, "adaptation", "adaptation", { within: "lanes", inactive: true });
    addTo(api, "twins", "twins", { within: "lanes", inactive: true });
    addTo(api, "hypotheses", "hypotheses", { within: "lanes", inactive: true });
    addTo(api, "behaviour", "behaviour", { within: "lanes", inactive: true });
    addTo(api, "phase", "phase", { within: "lanes", inactive: true });
    addTo(api, "spectrum", "spectrum", { within: "lanes", inactive: true });
    addTo(api, "identify", "identify", { within: "lanes", inactive: true });
    addTo(api, "recordings", "recordings", { within: "lanes", inactive: true });
    size(api, width, height, {
      schematic: { w: Math.max(0.225, LOOP_PX.width / width), h: Math.max(0.32, LOOP_PX.height / height) },
      ...(wide ? { view3d: { w: 0.25, h: 0.4 } } : {}),
      motion: { h: 0.308 },
      voltage: { h: 0.294 },
      lanes: { h: 0.398 },
    });
  },
};
