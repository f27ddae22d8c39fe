import type { Cue } from "../../api/types";
import { dockNow, panelWith, showBeside, showPanel, viewOf } from "../../bench/dock";
import { layoutAt } from "../../bench/lecture";
import { panelOf } from "../../bench/panel-views";
import { pickSample, weighingDiagnosers } from "../../bench/why";
import { scopeConfig } from "../../stream/scope-config";
import { layOutForScript } from "../layouts";

/** A view without a panel opens among the first of these that is open. */
const BESIDE = ["lanes", "why", "faults", "view3d"];

interface Place {
  at: number;
  tick: number;
}

/** The views for an audience, besides the views that a cue names. */
const FOR_AUDIENCE = ["time", "lanes", "view3d"];

/**
 * Lay the panels out as a cue wants them; without lanes where the bench has no diagnoser. An audience sees no other panels.
 *
 * Why is asked of the sample at which the cue begins.
 */
export function showCue(script: readonly Cue[], { at, tick }: Place, diagnoses: boolean, present: boolean): void {
  const { panels, signals, window_ms } = script[at];
  layOutForScript(layoutAt(script, at));
  const scope = panelWith("time");
  if (scope && signals.length > 0) {
    scope.api.updateParameters({ view: "time", scope: scopeConfig(signals, window_ms ? { windowMs: window_ms } : {}) });
    scope.api.setTitle("Scope");
  }
  scope?.api.setActive();
  if (!diagnoses) panelWith("lanes")?.api.close();
  if (present) keepOnly([...FOR_AUDIENCE, ...panels]);
  const among = BESIDE.find(panelWith);
  panels.forEach((view, i) => {
    showPanel(view, among);
    const hidden = panels.slice(0, i).find((other) => panelWith(other)?.group === panelWith(view)?.group);
    if (hidden) showBeside(view, hidden);
  });
  const [diagnoser] = weighingDiagnosers();
  if (diagnoser && panels.includes("why")) pickSample(diagnoser, tick - 1);
}

function keepOnly(views: readonly string[]): void {
  const owners = views.map(panelOf);
  for (const panel of [...(dockNow()?.panels ?? [])]) if (!owners.includes(panelOf(viewOf(panel)))) panel.api.close();
}
