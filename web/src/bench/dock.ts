import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import type { DockviewApi, IDockviewPanel, SerializedDockview } from "dockview-react";
import { createElement } from "react";
import { create } from "zustand";
import type { Document } from "../api/types";
import { scopeConfig } from "../stream/scope-config";
import { firstView, folded, hasSeveral, panelOf } from "./panel-views";
import { useView } from "./view-store";

/** A layout as it is passed on: the panels, whether they are in large type, and for which kind of bench. */
export interface SharedLayout {
  dock: SerializedDockview;
  large: boolean;
  axes: boolean;
}

/** A panel that was closed, how all panels stood with it, and how without. */
interface Closed {
  panel: SerializedDockview["panels"][string];
  group: string;
  index: number;
  before: SerializedDockview;
  after: string;
}

const MOST_CLOSED = 20;
const CLOSED_NOTICE = "panel-closed";

/** The dock of the page; a phone has none. */
export const useDock = create<{ dock: DockviewApi | undefined; closed: Closed[] }>(() => ({
  dock: undefined,
  closed: [],
}));

/** The dock, once the page has one. */
export const dockNow = (): DockviewApi | undefined => useDock.getState().dock;

/** The present layout, to be stored with a recording. */
export const layoutNow = () => dockNow()?.toJSON() as Document | undefined;

/** Put the panels as they stood; returns whether this version knows them all. */
export function restoreLayout(layout: Document | SerializedDockview): boolean {
  try {
    forgetClosed();
    dockNow()?.fromJSON(withGaps(folded(layout as unknown as SerializedDockview)));
    requestAnimationFrame(revealActiveTabs);
    return true;
  } catch (error) {
    console.warn("the stored layout does not fit this version", error);
    return false;
  }
}

/** Close a panel; it can be brought back. */
export function closePanel(panel: IDockviewPanel): void {
  const dock = dockNow();
  if (!dock) return;
  const { group, title } = panel;
  const before = dock.toJSON();
  const index = group.panels.indexOf(panel);
  panel.api.close();
  const after = JSON.stringify(dock.toJSON().grid);
  const last = { panel: before.panels[panel.id], group: group.id, index, before, after };
  useDock.setState(({ closed }) => ({ closed: [...closed, last].slice(-MOST_CLOSED) }));
  notifications.hide(CLOSED_NOTICE);
  notifications.show({ id: CLOSED_NOTICE, title: `${title} closed.`, message: undoButton() });
}

const undoButton = () =>
  createElement(
    Button<"button">,
    { size: "compact-sm", variant: "default", onClick: () => void reopenClosed() },
    "Undo",
  );

/** Forget the closed panels before another layout replaces this one. */
export function forgetClosed(): void {
  useDock.setState({ closed: [] });
  notifications.hide(CLOSED_NOTICE);
}

/** Bring the panel closed last back to its place; false when there is none. */
export function reopenClosed(): boolean {
  const { dock, closed } = useDock.getState();
  const last = closed.at(-1);
  if (!dock || !last) return false;
  useDock.setState({ closed: closed.slice(0, -1) });
  notifications.hide(CLOSED_NOTICE);
  const { panel, group, index, before, after } = last;
  if (dock.getPanel(panel.id)) return reopenClosed();
  if (JSON.stringify(dock.toJSON().grid) === after)
    dock.fromJSON(withGaps(before), { reuseExistingPanels: true }); // nothing else has moved
  else
    dock.addPanel({
      id: panel.id,
      component: panel.contentComponent ?? "scope",
      ...(panel.title ? { title: panel.title } : {}),
      params: panel.params ?? {},
      ...(dock.getGroup(group) ? { position: { referenceGroup: group, index } } : {}),
    });
  dock.getPanel(panel.id)?.api.setActive();
  return true;
}

/** Open another panel with a view, among the panels that have one of another view if there is one, else beside the active panel. */
export function addPanel(view: string, among?: string): IDockviewPanel | undefined {
  const component = panelOf(view);
  if (!component) return undefined;
  return dockNow()?.addPanel({
    id: `${component}-${Date.now()}`,
    component,
    params: { view },
    position: within(among),
  });
}

/** Open a scope on some signals, among the panels that have a view if there is one, else beside the active panel. */
export function addScope(title: string, signals: string[], among?: string): void {
  const params = { scope: scopeConfig(signals) };
  dockNow()?.addPanel({ id: `scope-${Date.now()}`, component: "scope", title, params, position: within(among) });
}

function within(among: string | undefined) {
  const near = among ? panelWith(among) : undefined;
  return near && { referencePanel: near.id, direction: "within" as const };
}

/** The view a docked panel shows. */
export const viewOf = ({ params, view }: IDockviewPanel): string =>
  (params as { view?: string } | undefined)?.view ?? firstView(view.contentComponent);

/** The panel that shows a view, else the panel that has it among others. */
export function panelWith(view: string): IDockviewPanel | undefined {
  const owner = panelOf(view);
  const all = dockNow()?.panels.filter((panel) => panel.view.contentComponent === owner) ?? [];
  return all.find((panel) => viewOf(panel) === view) ?? (owner && hasSeveral(owner) ? undefined : all[0]);
}

/** Turn a docked panel to one of its views. */
export function turnTo(panel: IDockviewPanel, view: string): void {
  panel.api.updateParameters({ ...panel.params, view });
}

/** The panel in front of each group, the active one last. */
export function inFront(): { id: string; view: string }[] {
  const active = dockNow()?.activePanel;
  const others = dockNow()?.groups.flatMap(({ activePanel }) => activePanel ?? []) ?? [];
  return [...others.filter((panel) => panel !== active), ...(active ? [active] : [])].map((panel) => ({
    id: panel.id,
    view: viewOf(panel),
  }));
}

/** Bring what was in front of another layout to the front of this one; the last of it is opened if no panel has it. */
export function bringBack(front: ReturnType<typeof inFront>): void {
  for (const [i, { id, view }] of front.entries()) {
    const panel = dockNow()?.getPanel(id) ?? panelWith(view);
    if (panel) {
      turnTo(panel, view);
      panel.api.setActive();
    } else if (i === front.length - 1) addPanel(view);
  }
}

/** Move the keyboard to the next group of panels. */
export function focusNextGroup(): void {
  const groups = dockNow()?.groups ?? [];
  const at = groups.findIndex((g) => g.element.contains(document.activeElement));
  const next = groups[(at + 1) % groups.length];
  next?.activePanel?.api.setActive();
  next?.element.querySelector<HTMLElement>("[role=tab][aria-selected=true], [role=tab], button")?.focus();
}

/** Bring a view to the front, opening a panel if none has it; without a dock it takes the place for one. */
export function showPanel(view: string, among?: string): void {
  useView.setState({ extra: view });
  const panel = panelWith(view);
  if (!panel) {
    addPanel(view, among);
    return;
  }
  turnTo(panel, view);
  panel.api.setActive();
}

/** Bring a view to the front in a column of its own at the right edge; without a dock nothing happens. */
export function showAtEdge(view: string, width: number): void {
  const dock = dockNow();
  if (!dock) return;
  if (dock.hasMaximizedGroup()) dock.exitMaximizedGroup();
  const panel = panelWith(view);
  if (panel) turnTo(panel, view);
  if (panel && panel.group.panels.length === 1) {
    panel.api.setActive();
    return;
  }
  const group = dock.addGroup({ direction: "right" });
  if (panel) panel.api.moveTo({ group });
  else addPanel(view)?.api.moveTo({ group });
  group.api.setSize({ width: Math.min(width, dock.width / 2) });
}

/**
 * Bring a view to the front beside another view, so that both are seen.
 *
 * A page without a dock has its own place for it.
 */
export function showBeside(view: string, anchor: string): void {
  const dock = dockNow();
  if (!dock) return;
  if (dock.hasMaximizedGroup()) dock.exitMaximizedGroup();
  const beside = panelWith(anchor);
  if (beside) turnTo(beside, anchor);
  let panel = panelWith(view);
  if (panel) turnTo(panel, view);
  if (!panel) {
    panel = addPanel(view);
    if (panel && beside) panel.api.moveTo({ group: beside.group, position: "right" });
  } else if (beside && panel.group === beside.group) panel.api.moveTo({ group: beside.group, position: "right" });
  beside?.api.setActive();
  panel?.api.setActive();
  revealActiveTabs();
}

/** The tabs of a narrow group scroll; the active tab must be visible. */
function revealActiveTabs(): void {
  for (const group of dockNow()?.groups ?? [])
    group.element
      .querySelector("[role=tab][aria-selected=true]")
      ?.scrollIntoView({ block: "nearest", inline: "center" });
}

type Node = SerializedDockview["grid"]["root"];

/** Between panels, px. */
export const DOCK_GAP = 6;

/**
 * A stored layout with the gaps put back into its sizes.
 *
 * The dock writes what a panel has left of its share after the gaps and reads it as the share itself, so that without
 * this each time the page is opened the panels give a pixel to the last one beside them.
 */
export function withGaps(stored: SerializedDockview): SerializedDockview {
  return { ...stored, grid: { ...stored.grid, root: padded(stored.grid.root) } };
}

function padded(node: Node): Node {
  if (!Array.isArray(node.data)) return node;
  const share = (DOCK_GAP * (node.data.length - 1)) / node.data.length;
  return { ...node, data: node.data.map((child) => padded({ ...child, size: (child.size ?? 0) + share })) };
}
