import type { AddPanelOptions, DockviewApi } from "dockview-react";
import { panelOf, type ViewName } from "../bench/panel-views";
import type { LayoutName } from "../bench/view-store";
import { type ScopeConfig, scopeConfig } from "../stream/scope-config";
import { isHere } from "./panels";

/** A scope of a layout, with its title. */
interface Scope {
  id: string;
  title: string;
  scope: ScopeConfig;
}

const scope = (id: string, title: string, signals: string[]): Scope => ({ id, title, scope: scopeConfig(signals) });

/** Displacement and tracking error, and the voltages. */
const SIMULATED = [
  scope("motion", "Displacement", ["plant.displacement", "sensor.displacement", "model.displacement"]),
  scope("tracking", "Tracking error", ["model.tracking_error"]),
  scope("voltage", "Voltage", ["reference.voltage", "drive.voltage"]),
];
/** Of a record: nothing drove the device along the reference of the bench. */
const RECORDED = [
  scope("motion", "Displacement", ["plant.displacement", "sensor.displacement"]),
  scope("voltage", "Voltage", ["drive.voltage"]),
];

/** The scope of the motion, also where there is no room for more. */
export const motionOf = (ofRecord: boolean): ScopeConfig => (ofRecord ? RECORDED : SIMULATED)[0].scope;

/** The smallest size of the loop; the panels below it are as wide. */
export const LOOP_PX = { width: 326, height: 312 };

/** A column of faults or controllers is read at this width. */
export const LIST_PX = 310;

/** In less than this a third column has no room; its panels are behind others, as many as have room for their tabs. */
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
  view: ViewName,
  { inactive = false, ...where }: Where = {},
  scope?: ScopeConfig,
  title?: string,
): void {
  if (!isHere(view)) return;
  const [direction, referencePanel] = Object.entries(where)[0] ?? [];
  const options = {
    id,
    component: panelOf(view),
    ...(title ? { title } : {}),
    params: { view, ...(scope ? { scope } : {}) },
    inactive,
    ...(direction ? { position: { direction, referencePanel } } : {}),
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

/** Two scopes, one behind the other; the third too where its tab has room. */
function addMotion(api: DockviewApi, [front, ...behind]: Scope[], wide: boolean): void {
  addTo(api, front.id, "time", {}, front.scope, front.title);
  for (const { id, scope, title } of wide ? behind : behind.slice(0, 1))
    addTo(api, id, "time", { within: front.id, inactive: true }, scope, title);
}

/** Panels one behind the other, the first in front. */
export function addBehind(api: DockviewApi, front: string, views: ViewName[]): void {
  for (const view of views) addTo(api, view, view, { within: front, inactive: true });
}

/** The layouts everybody has; sizes are shares of the page. */
export type Layouts = Record<LayoutName, (api: DockviewApi, width: number, height: number) => void>;

/** Layouts around some scopes; `motion` is the first. */
const layoutsAround = (scopes: Scope[]): Layouts => ({
  lecture(api, width, height) {
    const [front, second] = scopes;
    addTo(api, front.id, "time", {}, front.scope, front.title);
    addTo(api, "lanes", "lanes", { right: "motion" });
    addTo(api, second.id, "time", { below: "motion" }, second.scope, second.title);
    addTo(api, "faults", "faults", { below: "lanes" });
    const wide = width >= THREE_COLUMNS_PX;
    addTo(api, "view3d", "view3d", wide ? { right: "faults" } : { within: "faults", inactive: true });
    size(api, width, height, {
      lanes: { w: 0.52, h: 0.54 },
      motion: { h: 0.5 },
      ...(wide ? { faults: { w: Math.max(0.26, LIST_PX / width) } } : {}),
    });
  },
  lab(api, width, height) {
    const wide = width >= THREE_COLUMNS_PX;
    addMotion(api, scopes, wide);
    addTo(api, "schematic", "schematic", { left: "motion" });
    addTo(api, "faults", "faults", { below: "schematic" });
    addBehind(api, "schematic", ["device"]);
    addBehind(api, "faults", ["controllers", "sheet"]);
    addTo(api, "lanes", "lanes", { below: "motion" });
    addBehind(api, "lanes", ["why"]);
    if (wide) addBehind(api, "lanes", ["identify", "twins", "narrator", "claims"]);
    size(api, width, height, {
      schematic: { w: Math.max(0.26, LOOP_PX.width / width), h: Math.max(0.34, LOOP_PX.height / height) },
      motion: { h: 0.5 },
    });
  },
  research(api, width, height) {
    const wide = width >= THREE_COLUMNS_PX;
    addMotion(api, scopes, wide);
    addTo(api, "schematic", "schematic", { left: "motion" });
    addTo(api, "faults", "faults", { below: "schematic" });
    addBehind(api, "faults", ["controllers"]);
    addTo(api, "view3d", "view3d", wide ? { right: "motion" } : { within: "schematic", inactive: true });
    addTo(api, "lanes", "lanes", { below: "motion" });
    if (wide) {
      addTo(api, "why", "why", { below: "view3d" });
      addBehind(api, "why", ["narrator", "claims"]);
      addBehind(api, "view3d", ["sheet"]); // a third tab does not fit beside the faults, which a sheet asks for
      addBehind(api, "schematic", ["device"]);
      addBehind(api, "lanes", ["identify", "twins"]);
    } else addBehind(api, "lanes", ["why", "device"]);
    size(api, width, height, {
      schematic: { w: Math.max(0.225, LOOP_PX.width / width), h: Math.max(0.32, LOOP_PX.height / height) },
      ...(wide ? { view3d: { w: 0.25, h: 0.45 } } : {}),
      motion: { h: 0.5 },
    });
  },
});

/** The layouts for a device with one displacement. */
export const BUILT_IN = layoutsAround(SIMULATED);

/** The layouts for a record of such a device. */
export const BUILT_IN_RECORD = layoutsAround(RECORDED);
