import type { Bench } from "../api/types";

/** One line that says what to try on this bench; nothing where nothing can be tried. */
export function tryThis(
  bench: Pick<Bench, "axes" | "controllers" | "diagnosers" | "replay_of" | "signals">,
): string | undefined {
  if (bench.replay_of) return undefined;
  const others = bench.controllers.length > 1;
  if (bench.axes.length > 0)
    return "change the angular rate under Controllers, and watch the estimate follow. Then let another sense controller read it.";
  if (!bench.signals.some((signal) => signal.name === "plant.displacement")) return undefined;
  const watched = Object.keys(bench.diagnosers).length > 0 ? "Diagnosis find it" : "the displacement follow";
  const inject = `inject Added mass +5 % under Faults, and watch ${watched}.`;
  return others ? `${inject} Then change the controller above.` : inject;
}
