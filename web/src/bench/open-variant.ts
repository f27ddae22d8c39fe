import { api } from "../api/api";
import { useBench } from "../stream/bench-store";
import { announce } from "./announce";
import { openOwn } from "./open-bench";
import { send } from "./send";

/**
 * Begin the bench again from tick 0 with values written over it, as a bench of its own.
 *
 * The one before is paused if nobody else watches it, so that going back finds it as it was.
 */
export async function openVariant(set: Record<string, unknown>, said: string): Promise<void> {
  const { bench } = useBench.getState();
  if (!bench) return;
  const made = await api.variant(bench.id, set);
  if (bench.state === "running" && (bench.watchers ?? 0) <= 1) await send({ kind: "pause" });
  openOwn(made.id);
  announce(said);
}
