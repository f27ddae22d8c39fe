import { createDockview, type DockviewApi } from "dockview-react";
import { afterEach, beforeEach, expect, it } from "vitest";
import type { Cue } from "../../api/types";
import { panelWith, viewOf } from "../../bench/dock";
import { useView } from "../../bench/view-store";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { attachDock } from "../layouts";
import { showCue } from "./show-cue";

const LECTURES = import.meta.glob<string>("../../../../scenarios/lectures/*.toml", {
  query: "?raw",
  import: "default",
  eager: true,
});
const { bench } = await recordedBench("seven-steps");

let dock: DockviewApi;
beforeEach(() => {
  const place = document.body.appendChild(document.createElement("div"));
  dock = createDockview(place, {
    createComponent: () => ({ element: document.createElement("div"), init: () => undefined }),
  });
  dock.layout(1366, 600);
  attachDock(dock);
});
afterEach(() => {
  dock.dispose();
  document.body.replaceChildren();
});

/** The names in a list of a file. */
const namesIn = (text: string, field: string): string[] =>
  [...(new RegExp(`^${field} = \\[(.*)\\]$`, "m").exec(text)?.[1] ?? "").matchAll(/"([^"]+)"/g)].map(
    ([, name]) => name,
  );

/** The cues of a file: the layout, and the panels and signals that each names. */
const cuesIn = (text: string): Cue[] =>
  text
    .split(/^\[\[cue\]\]$/m)
    .slice(1)
    .map((cue) => ({
      title: /^title = "(.*)"$/m.exec(cue)?.[1] ?? "",
      layout: /^layout = "(\w+)"$/m.exec(cue)?.[1] ?? null,
      panels: namesIn(cue, "panels"),
      signals: namesIn(cue, "signals"),
      window_ms: null,
      ...{ minutes: 1, say: "", ask: "", see: "", from_ms: 0, until_ms: 0, vote: null },
    }));

const kinds = () => dock.panels.map((panel) => viewOf(panel));

const walked = Object.entries(LECTURES).flatMap(([path, text]) =>
  [true, false].map((diagnoses) => ({ name: path.split("/").at(-1), cues: cuesIn(text), diagnoses })),
);

it("walks all five lectures", () => {
  expect(Object.keys(LECTURES)).toHaveLength(5);
  for (const { cues, name } of walked) expect(cues.length, name).toBeGreaterThan(8);
});

it.each(walked)("opens each panel that a cue of $name names, diagnosers on the bench: $diagnoses", ({
  cues,
  diagnoses,
}) => {
  connect(diagnoses ? bench : { ...bench, diagnosers: {} });
  cues.forEach((cue, at) => {
    showCue(cues, { at, tick: 100 }, diagnoses, false);
    for (const view of cue.panels) {
      const panel = panelWith(view);
      expect(panel && viewOf(panel), `${cue.title}: ${view}`).toBe(view);
      expect(panel?.group.activePanel?.id, `${cue.title}: ${view} is in front`).toBe(panel?.id);
    }
  });
});

const cue = (panels: string[]): Cue => ({ ...cuesIn("\n[[cue]]\n")[0], title: "A cue", panels });

it("shows an audience scopes, lanes, 3D, the panels of the cue and nothing else", () => {
  connect(bench);
  showCue([cue([])], { at: 0, tick: 100 }, true, false);
  expect(kinds()).toContain("faults");
  showCue([cue([])], { at: 0, tick: 100 }, true, true);
  expect(new Set(kinds())).toEqual(new Set(["time", "lanes", "view3d"]));
  showCue([cue(["adaptation"])], { at: 0, tick: 100 }, true, true);
  expect(new Set(kinds())).toEqual(new Set(["time", "lanes", "view3d", "adaptation"]));
});

it("opens Why with the sample at which its cue begins", () => {
  connect(bench);
  showCue([cue(["why"])], { at: 0, tick: 3200 }, true, false);
  expect(useView.getState().sample).toEqual({ diagnoser: "kalman", tick: 3199 });
  expect(panelWith("why")?.group.activePanel).toBe(panelWith("why"));
  expect(panelWith("lanes")?.group.activePanel).toBe(panelWith("lanes"));
});
