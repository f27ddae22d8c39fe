import type { DockviewApi, SerializedDockview } from "dockview-react";
import { hasAxes } from "../api/fits";
import { dockNow, holdDock, restoreLayout } from "../bench/dock";
import { keepLayout, type LayoutName, useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import { BUILT_IN } from "./built-in-layouts";
import { PANELS } from "./panels";
import { BUILT_IN_AXES } from "./two-axis-layouts";

/** Whether the panels stand as for a bench with axes. */
let axes = false;

const storageKey = (name: LayoutName) => `combbench.layout.4.${axes ? "axes." : ""}${name}`;

/** Lay the panels out for the benches of a kind; within one kind they stay where they are. */
export function layOutFor(withAxes: boolean): void {
  if (withAxes === axes) return;
  axes = withAxes;
  const name = useView.getState().layout;
  arrange(name, stored(name));
}

/** The dock to lay out; called once it stands. A panel without a title of its own has that of its kind. */
export function attachDock(api: DockviewApi): void {
  holdDock(api);
  api.onDidAddPanel((panel) => {
    if (!panel.title || panel.title === panel.id) panel.api.setTitle(PANELS[panel.view.contentComponent].title);
  });
  axes = hasAxes(useBench.getState().bench);
  const name = useView.getState().layout;
  arrange(name, stored(name));
  api.onDidLayoutChange(() =>
    localStorage.setItem(storageKey(useView.getState().layout), JSON.stringify(api.toJSON())),
  );
}

/** Choose a built-in layout afresh; what was rearranged in it is forgotten. The address names it. */
export function setLayout(name: LayoutName): void {
  localStorage.removeItem(storageKey(name));
  keepLayout(name);
  arrange(name, undefined);
}

function stored(name: LayoutName): SerializedDockview | undefined {
  const text = localStorage.getItem(storageKey(name));
  return text ? (JSON.parse(text) as SerializedDockview) : undefined;
}

function arrange(name: LayoutName, saved: SerializedDockview | undefined): void {
  const api = dockNow();
  useView.setState({ layout: name });
  if (!api) return;
  if (saved && restoreLayout(saved)) return;
  localStorage.removeItem(storageKey(name));
  api.clear();
  (axes ? BUILT_IN_AXES : BUILT_IN)[name](api, api.width || window.innerWidth, api.height || window.innerHeight);
}
