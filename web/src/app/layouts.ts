import type { DockviewApi, SerializedDockview } from "dockview-react";
import { hasAxes } from "../api/fits";
import type { Document } from "../api/types";
import { scopeConfig } from "../panels/scope/scope-config";
import { useBench } from "../stream/bench-store";
import { BUILT_IN } from "./built-in-layouts";
import { withGaps } from "./dock-gap";
import { PANELS } from "./panels";
import { BUILT_IN_AXES } from "./two-axis-layouts";
import { type LayoutName, useView } from "./view-store";

let current: DockviewApi | undefined;

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

/** The dock to lay out; called once it stands. */
export function attachDock(api: DockviewApi): void {
  current = api;
  axes = hasAxes(useBench.getState().bench);
  const asked = new URLSearchParams(window.location.search).get("layout");
  const name = asked && asked in BUILT_IN ? (asked as LayoutName) : useView.getState().layout;
  arrange(name, stored(name));
  api.onDidLayoutChange(() =>
    localStorage.setItem(storageKey(useView.getState().layout), JSON.stringify(api.toJSON())),
  );
}

/** Choose a built-in layout afresh; what was rearranged in it is forgotten. The address names it. */
export function setLayout(name: LayoutName): void {
  localStorage.removeItem(storageKey(name));
  const url = new URL(window.location.href);
  url.searchParams.set("layout", name);
  window.history.replaceState(null, "", url);
  arrange(name, undefined);
}

/** How the panels stand now, to be kept with a recording. */
export const layoutNow = () => current?.toJSON() as Document | undefined;

/** Put the panels as they stood when a recording was made. */
export function restoreLayout(layout: Document): void {
  arrange(useView.getState().layout, layout as unknown as SerializedDockview);
}

/** Open another panel of a kind beside the active one. */
export function addPanel(kind: string): void {
  current?.addPanel({ id: `${kind}-${Date.now()}`, component: kind, title: PANELS[kind].title, params: {} });
}

/** Open a scope on some signals beside the active panel. */
export function addScope(title: string, signals: string[]): void {
  current?.addPanel({ id: `scope-${Date.now()}`, component: "scope", title, params: { scope: scopeConfig(signals) } });
}

/** Move the keyboard to the next group of panels. */
export function focusNextGroup(): void {
  const groups = current?.groups ?? [];
  const at = groups.findIndex((g) => g.element.contains(document.activeElement));
  const next = groups[(at + 1) % groups.length];
  next?.activePanel?.api.setActive();
  next?.element.querySelector<HTMLElement>("[role=tab][aria-selected=true], [role=tab], button")?.focus();
}

/** Bring the panel of a kind to the front, opening one if there is none; without a dock it takes the place for one. */
export function showPanel(kind: string): void {
  useView.setState({ extra: kind });
  const panel = current?.panels.find((p) => p.view.contentComponent === kind);
  if (panel) panel.api.setActive();
  else addPanel(kind);
}

function stored(name: LayoutName): SerializedDockview | undefined {
  const text = localStorage.getItem(storageKey(name));
  return text ? (JSON.parse(text) as SerializedDockview) : undefined;
}

/** The tabs of a narrow group scroll; the one whose panel is shown must be among those seen. */
function revealActiveTabs(): void {
  for (const group of current?.groups ?? [])
    group.element
      .querySelector("[role=tab][aria-selected=true]")
      ?.scrollIntoView({ block: "nearest", inline: "center" });
}

function arrange(name: LayoutName, saved: SerializedDockview | undefined): void {
  const api = current;
  useView.setState({ layout: name, large: name === "lecture" });
  document.documentElement.dataset.size = name === "lecture" ? "large" : "normal";
  if (!api) return;
  if (saved) {
    try {
      api.fromJSON(withGaps(saved));
      requestAnimationFrame(revealActiveTabs);
      return;
    } catch (error) {
      console.warn("the stored layout does not fit this version", error);
      localStorage.removeItem(storageKey(name));
    }
  }
  api.clear();
  (axes ? BUILT_IN_AXES : BUILT_IN)[name](api, api.width || window.innerWidth, api.height || window.innerHeight);
}
