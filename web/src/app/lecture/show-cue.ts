import type { Cue } from "../../api/types";
import { panelWith, showPanel } from "../../bench/dock";
import { layoutAt } from "../../bench/lecture";
import { scopeConfig } from "../../stream/scope-config";
import { layOutForScript } from "../layouts";

/** Lay the panels out as a cue wants them, also after somebody moved them; without lanes where nobody diagnoses. */
export function showCue(script: readonly Cue[], at: number, diagnoses: boolean): void {
  const { panels, signals, window_ms } = script[at];
  layOutForScript(layoutAt(script, at));
  const scope = panelWith("time");
  if (scope && signals.length > 0) {
    scope.api.updateParameters({ view: "time", scope: scopeConfig(signals, window_ms ? { windowMs: window_ms } : {}) });
    scope.api.setTitle("Scope");
  }
  scope?.api.setActive();
  if (!diagnoses) panelWith("lanes")?.api.close();
  for (const panel of panels) showPanel(panel, diagnoses ? "lanes" : "faults");
}
