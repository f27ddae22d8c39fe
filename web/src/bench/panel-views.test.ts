import { Orientation, type SerializedDockview } from "dockview-react";
import { expect, it } from "vitest";
import { firstView, folded, panelOf, VIEWS } from "./panel-views";

/** The panels of the version before views. */
const EARLIER = (
  "scope lanes adaptation behaviour hypotheses labs blind games sheet twins why schematic controllers locus allan " +
  "faults card editor sets environment phase spectrum identify recordings events narrator claims scores vote view3d"
).split(" ");

type Node = SerializedDockview["grid"]["root"];

const leaf = (views: string[], activeView = views[0]): Node =>
  ({ type: "leaf", size: 100, data: { id: views.join(), views, activeView } }) as Node;
const branch = (...data: Node[]): Node => ({ type: "branch", size: 100, data }) as Node;

function layout(root: Node, kinds: Record<string, string>): SerializedDockview {
  const panels = Object.fromEntries(
    Object.entries(kinds).map(([id, contentComponent]) => [id, { id, contentComponent, params: {} }]),
  );
  return { grid: { root, width: 1000, height: 800, orientation: Orientation.HORIZONTAL }, panels };
}

const groups = ({ grid }: SerializedDockview): string[][] => {
  const walk = (node: Node): string[][] =>
    Array.isArray(node.data) ? node.data.flatMap(walk) : [(node.data as { views: string[] }).views];
  return walk(grid.root);
};

it("has each view once, and none with the name of another panel", () => {
  const views = Object.values(VIEWS).flat();
  expect(new Set(views).size).toBe(views.length);
  for (const [panel, own] of Object.entries(VIEWS)) {
    expect(own.length, panel).toBeLessThanOrEqual(5);
    const namesake = views.find((view) => view === panel);
    if (namesake) expect(panelOf(namesake), panel).toBe(panel);
  }
});

it.each(EARLIER.filter((kind) => kind !== "editor"))("opens a panel %s of an earlier layout with its view", (kind) => {
  const found = folded(layout(branch(leaf(["a"])), { a: kind }));
  const panel = found.panels.a;
  const component = panel.contentComponent ?? "";
  expect(component in VIEWS).toBe(true);
  const view = (panel.params as { view?: string }).view ?? firstView(component);
  expect(view).toBe(kind === "scope" ? "time" : kind);
  expect(panelOf(view)).toBe(component);
});

it("folds panels of one group into one, turned to the view that was in front", () => {
  const kinds = { l: "lanes", h: "hypotheses", s: "scores", e: "events", a: "scope", b: "scope" };
  const found = folded(layout(branch(leaf(["l", "h", "s", "e"], "s"), leaf(["a", "b"], "b")), kinds));
  expect(groups(found)).toEqual([
    ["s", "e"],
    ["a", "b"],
  ]);
  expect(found.panels.s).toMatchObject({ contentComponent: "diagnosis", params: { view: "scores" } });
  expect(Object.keys(found.panels).sort()).toEqual(["a", "b", "e", "s"]);
});

it("leaves out the editor, and a group of it alone", () => {
  const found = folded(layout(branch(leaf(["l"]), branch(leaf(["e"]))), { l: "lanes", e: "editor" }));
  expect(groups(found)).toEqual([["l"]]);
  expect(Object.keys(found.panels)).toEqual(["l"]);
});

it("leaves a layout of today as it is", () => {
  const now = layout(branch(leaf(["d"]), leaf(["s"])), { d: "diagnosis", s: "scope" });
  now.panels.d.params = { view: "scores" };
  now.panels.s.params = { view: "phase" };
  expect(folded(now)).toEqual(now);
});
