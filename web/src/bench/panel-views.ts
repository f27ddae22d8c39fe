import type { SerializedDockview } from "dockview-react";

/**
 * The panels in the order of the menu, each with its views.
 *
 * The names of the views are what lectures, links and layouts call them; the views were panels once.
 */
export const VIEWS = {
  device: ["device", "sensor", "environment", "board"],
  loop: ["schematic", "card"],
  controller: ["controllers", "parameters", "sets", "adaptation", "behaviour"],
  faults: ["faults"],
  scope: ["time", "spectrum", "phase"],
  response: ["identify"],
  view3d: ["view3d"],
  diagnosis: ["lanes", "hypotheses", "labs", "scores"],
  why: ["why"],
  compare: ["twins", "behind", "recordings"],
  log: ["narrator", "events"],
  published: ["claims"],
  lesson: ["sheet", "vote", "blind", "games"],
  motion: ["locus"],
  rate: ["allan"],
} as const;

export type PanelName = keyof typeof VIEWS;
export type ViewName = (typeof VIEWS)[PanelName][number];

/** Panels that can be open several times, each with its own contents. */
const SEVERAL: PanelName[] = ["scope"];

/** The panel that has a view. */
export function panelOf(view: string): PanelName | undefined {
  return (Object.keys(VIEWS) as PanelName[]).find((name) => (VIEWS[name] as readonly string[]).includes(view));
}

/** The view a panel opens with. */
export const firstView = (panel: string): string => (isPanel(panel) ? VIEWS[panel][0] : panel);

export const isPanel = (name: string): name is PanelName => name in VIEWS;

export const hasSeveral = (panel: string): boolean => SEVERAL.includes(panel as PanelName);

type Node = SerializedDockview["grid"]["root"];
type Leaf = { id: string; views: string[]; activeView?: string };

/** A layout whose panels may have the names of an earlier version; the editor, which was a panel, is left out. */
export function folded(layout: SerializedDockview): SerializedDockview {
  const panels: SerializedDockview["panels"] = {};
  for (const [id, panel] of Object.entries(layout.panels)) {
    const name = panel.contentComponent ?? "";
    const owner = isPanel(name) ? name : panelOf(name);
    if (owner)
      panels[id] =
        owner === name ? panel : { ...panel, contentComponent: owner, params: { ...panel.params, view: name } };
  }
  const root = keptNode(layout.grid.root, panels);
  const left = new Set(leaves(root).flatMap(({ views }) => views));
  for (const id of Object.keys(panels)) if (!left.has(id)) delete panels[id];
  return { ...layout, panels, grid: { ...layout.grid, root: root ?? layout.grid.root } };
}

/** A node without the panels that are gone, and with each panel once in a group. */
function keptNode(node: Node, panels: SerializedDockview["panels"]): Node | undefined {
  if (Array.isArray(node.data)) {
    const data = node.data.flatMap((child) => keptNode(child, panels) ?? []);
    return data.length > 0 ? { ...node, data } : undefined;
  }
  const leaf = node.data as Leaf;
  const active = leaf.activeView;
  const views: string[] = [];
  for (const id of leaf.views) {
    const kind = panels[id]?.contentComponent;
    if (!kind) continue;
    const twin = hasSeveral(kind) ? -1 : views.findIndex((other) => panels[other].contentComponent === kind);
    if (twin < 0) views.push(id);
    else if (id === active) views[twin] = id;
  }
  if (views.length === 0) return undefined;
  const shown = active && views.includes(active) ? active : views[0];
  return { ...node, data: { ...leaf, views, activeView: shown } as typeof node.data };
}

function leaves(node: Node | undefined): Leaf[] {
  if (!node) return [];
  return Array.isArray(node.data) ? node.data.flatMap(leaves) : [node.data as Leaf];
}
