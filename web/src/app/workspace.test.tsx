import { act, screen } from "@testing-library/react";
import type { DockviewApi, SerializedDockview } from "dockview-react";
import { beforeEach, expect, it, vi } from "vitest";
import {
  addPanel,
  closePanel,
  dockNow,
  panelWith,
  reopenClosed,
  restoreLayout,
  showAtEdge,
  showBeside,
  showPanel,
  viewOf,
} from "../bench/dock";
import { isPanel, VIEWS } from "../bench/panel-views";
import { connect } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { BUILT_IN } from "./built-in-layouts";
import { setLayout } from "./layouts";
import { PANELS, suits, VIEW, viewsOn } from "./panels";
import { BUILT_IN_AXES } from "./two-axis-layouts";
import { Workspace } from "./workspace";

vi.mock("./panel-body", () => ({ PanelBody: ({ view }: { view: string }) => <p>This is the view {view}</p> }));

const flat = (await recordedBench("first-look")).bench;
const gyroscope = (await recordedBench("gyroscope")).bench;
/** The page on a projector, and on a tablet, px. */
const WIDTHS = [1366, 820];
const NAMES = ["lecture", "lab", "research"] as const;

beforeEach(() => {
  window.innerWidth = WIDTHS[0];
});

/** The panels of a bench in a layout. */
function layOut(name: (typeof NAMES)[number] = "lab", bench = flat): DockviewApi {
  connect(bench);
  mount(<Workspace />);
  act(() => setLayout(name));
  return dockNow() as DockviewApi;
}
const kinds = (dock: DockviewApi) => dock.panels.map((panel) => panel.view.contentComponent);
const titles = (dock: DockviewApi) => dock.panels.map((panel) => panel.title);
/** The views in front, one for each group. */
const inFront = (dock: DockviewApi) =>
  dock.groups.map(({ activePanel }) => activePanel && viewOf(activePanel)).filter(Boolean);

it("has a lecture of two scopes, Diagnosis, Faults and 3D, and no more", () => {
  const dock = layOut("lecture");
  expect(titles(dock).sort()).toEqual(["3D", "Diagnosis", "Displacement", "Faults", "Tracking error"]);
  expect(kinds(dock).filter((kind) => kind === "scope")).toHaveLength(2);
});

it("shows displacement and voltage of a record, and keeps the layouts of other benches", () => {
  const record = { ...flat, record: { key: "a".repeat(64), samples: 100, labels: [] } };
  const dock = layOut("lecture", record);
  expect(titles(dock).sort()).toEqual(["3D", "Diagnosis", "Displacement", "Faults", "Voltage"]);
  act(() => setLayout("lab"));
  expect(titles(dock)).not.toContain("Tracking error");
  act(() => connect(flat));
  act(() => setLayout("lecture"));
  expect(titles(dock)).toContain("Tracking error");
});

const EVERY = [flat, gyroscope].flatMap((bench) =>
  NAMES.flatMap((name) => WIDTHS.map((width) => ({ bench, name, width, of: bench === flat ? "plate" : "gyroscope" }))),
);

it.each(EVERY)("has each panel once, but for scopes, in the $name layout of a $of at $width px", ({
  bench,
  name,
  width,
}) => {
  window.innerWidth = width;
  const dock = layOut(name, bench);
  const but = kinds(dock).filter((kind) => kind !== "scope");
  expect(new Set(but).size).toBe(but.length);
  for (const panel of dock.panels) {
    expect(isPanel(panel.view.contentComponent), panel.id).toBe(true);
    expect(suits(VIEW[viewOf(panel) as keyof typeof VIEW], bench), `${panel.id} suits the bench`).toBe(true);
  }
});

it.each([
  BUILT_IN,
  BUILT_IN_AXES,
])("has the tools of an exercise in the lab layout, and of a study in the other", (of) => {
  const bench = of === BUILT_IN ? flat : gyroscope;
  const lab = kinds(layOut("lab", bench));
  for (const kind of ["loop", "faults", "controller", "diagnosis", "lesson"]) expect(lab, kind).toContain(kind);
  expect(lab).not.toContain("view3d");
  act(() => setLayout("research"));
  const research = kinds(dockNow() as DockviewApi);
  for (const kind of ["loop", "faults", "controller", "diagnosis", "view3d"]) expect(research, kind).toContain(kind);
});

it("brings a view to the front, and turns its panel to it", () => {
  const dock = layOut();
  const before = dock.panels.length;
  act(() => showPanel("scores"));
  expect(dock.panels).toHaveLength(before);
  expect(inFront(dock)).toContain("scores");
  expect(screen.getByText("This is the view scores")).toBeInTheDocument();
  expect(screen.queryByText("This is the view lanes")).not.toBeInTheDocument();
});

it("opens a panel for a view that no panel has, among the panels of another view", () => {
  const dock = layOut("lecture");
  act(() => showPanel("blind", "faults"));
  const opened = panelWith("blind");
  expect(opened?.title).toBe("Lesson");
  expect(opened?.group).toBe(panelWith("faults")?.group);
  expect(inFront(dock)).toContain("blind");
});

it("opens a scope for another view of a scope, and leaves the scopes as they are", () => {
  const dock = layOut("lecture");
  act(() => showPanel("phase"));
  expect(kinds(dock).filter((kind) => kind === "scope")).toHaveLength(3);
  expect(dock.panels.filter((panel) => viewOf(panel) === "time")).toHaveLength(2);
});

it.each([flat, gyroscope])("opens every view of a bench by the name that links and lectures have for it", (bench) => {
  layOut("lecture", bench);
  const views = Object.values(VIEWS).flat();
  for (const view of views.filter((view) => suits(VIEW[view], bench))) {
    act(() => showPanel(view));
    const panel = panelWith(view);
    expect(panel?.api.isActive, view).toBe(true);
    expect(panel && viewOf(panel)).toBe(view);
    expect(screen.getAllByText(`This is the view ${view}`).length).toBeGreaterThan(0);
  }
});

it("shows a view beside another, each in a group of its own", () => {
  const dock = layOut();
  expect(panelWith("why")?.group).toBe(panelWith("lanes")?.group);
  act(() => showBeside("why", "lanes"));
  expect(panelWith("why")?.group).not.toBe(panelWith("lanes")?.group);
  expect(inFront(dock)).toEqual(expect.arrayContaining(["why", "lanes"]));
});

it("shows a view beside another that its panel was turned away from", () => {
  const dock = layOut("lecture");
  act(() => showPanel("scores"));
  act(() => showBeside("why", "lanes"));
  expect(inFront(dock)).toEqual(expect.arrayContaining(["why", "lanes"]));
});

it("shows a view in a group of its own at the edge", () => {
  const dock = layOut();
  act(() => showAtEdge("sheet", 400));
  expect(panelWith("sheet")?.group.panels).toHaveLength(1);
  expect(inFront(dock)).toContain("sheet");
  const groups = dock.groups.length;
  act(() => showAtEdge("vote", 400)); // the panel is at the edge already
  expect(dock.groups).toHaveLength(groups);
  expect(inFront(dock)).toContain("vote");
});

it("brings a closed panel back to its place, turned as it was", () => {
  const dock = layOut();
  act(() => showPanel("scores"));
  const before = titles(dock);
  act(() => closePanel(panelWith("scores") as never));
  expect(titles(dock)).not.toContain("Diagnosis");
  act(() => void reopenClosed());
  expect(titles(dock).sort()).toEqual(before.sort());
  expect(inFront(dock)).toContain("scores");
});

it("gives a panel the title of its kind, and a scope that of its signals", () => {
  const dock = layOut();
  act(() => void addPanel("hypotheses"));
  expect(dock.panels.at(-1)?.title).toBe("Diagnosis");
  expect(titles(dock)).toEqual(expect.arrayContaining(["Displacement", "Tracking error"]));
});

/** Groups of panels that the lab layout of the version before views had. */
const EARLIER = [
  ["scope", "scope", "scope"],
  ["schematic", "card"],
  ["faults", "controllers", "environment", "sets"],
  [
    "lanes",
    "hypotheses",
    "labs",
    "blind",
    "games",
    "sheet",
    "twins",
    "why",
    "identify",
    "events",
    "narrator",
    "claims",
  ],
  ["editor"],
];

/** The rows and columns of the panels, without their sizes. */
const shape = (dock: DockviewApi) =>
  JSON.stringify(dock.toJSON().grid.root, (key, value) => (key === "size" ? undefined : value));

it("is laid out again when its window becomes too narrow for a third column, and keeps what was arranged for either", async () => {
  const dock = layOut("lecture");
  const resize = async (width: number, expected: () => void) => {
    act(() => dock.layout(width, 700));
    await act(() => vi.waitFor(expected));
  };
  /** A change is kept a moment after it was made. */
  const isKept = (name: string) =>
    act(() => vi.waitFor(() => expect(localStorage.getItem(name)).toBe(JSON.stringify(dock))));
  const [third, behind] = [
    () => expect(panelWith("view3d")?.group.id).not.toBe(panelWith("faults")?.group.id),
    () => expect(panelWith("view3d")?.group.id).toBe(panelWith("faults")?.group.id),
  ];
  await resize(WIDTHS[0], third);
  act(() => showAtEdge("labs", 400));
  await isKept("combbench.layout.4.lecture");
  const arranged = shape(dock);
  await resize(WIDTHS[1], behind);
  expect(inFront(dock)).toEqual(expect.arrayContaining(["labs", "time"])); // it was in front
  act(() => closePanel(panelWith("faults") as never));
  await isKept("combbench.layout.4.narrow.lecture");
  await resize(WIDTHS[0], third);
  expect(shape(dock)).toBe(arranged);
  await resize(WIDTHS[1], () => expect(titles(dock)).not.toContain("Faults"));
});

it("opens a layout of the version before views, each panel once", () => {
  const dock = layOut();
  const groups = EARLIER.map((names, at) => names.map((name, i) => ({ id: `${at}-${i}`, name })));
  const data = groups.map((group, at) => {
    const views = group.map(({ id }) => id);
    return { type: "leaf", size: 200, data: { id: `group-${at}`, views, activeView: views.at(-1) } };
  });
  const panels = groups.flat().map(({ id, name }) => [id, { id, contentComponent: name, params: {} }]);
  const grid = { root: { type: "branch", size: 700, data }, width: 1000, height: 700, orientation: "HORIZONTAL" };
  const earlier = { grid, panels: Object.fromEntries(panels) } as unknown as SerializedDockview;
  act(() => expect(restoreLayout(earlier)).toBe(true));
  expect(dock.groups).toHaveLength(4);
  expect(inFront(dock)).toEqual(["time", "card", "sets", "claims"]);
  const found = [...new Set(kinds(dock))].map((kind) => PANELS[kind as keyof typeof PANELS].title);
  expect(found.join()).toBe(
    "Scope,Loop,Faults,Controller,Device,Diagnosis,Lesson,Compare,Why,Frequency response,Log,Published",
  );
});

it("says which views a bench has", () => {
  expect(viewsOn("diagnosis", flat)).toEqual(["lanes", "hypotheses", "labs", "scores"]);
  expect(viewsOn("diagnosis", gyroscope)).toEqual(["lanes", "scores"]);
  expect(viewsOn("motion", flat)).toEqual([]);
  expect(viewsOn("motion", gyroscope)).toEqual(["locus"]);
});
