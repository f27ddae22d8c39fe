import { api } from "../api/api";
import type { BlockCard } from "../api/types";
import { cardOf } from "../api/use-catalog";
import { useBench } from "../stream/bench-store";
import { announce } from "./announce";
import { openOwn } from "./open-bench";
import { send } from "./send";
import { sourceOnBench, valuesOf } from "./unit-values";
import { untilBench } from "./until-bench";

/** The bench that was made last for a unit; the next one takes its place. */
let made: string | undefined;

const MOST_WAIT_MS = 5000;

/** Whether a bench can take the text by a reset: it has the same outputs and taps. */
const isAlike = (before: BlockCard | undefined, now: BlockCard): boolean =>
  JSON.stringify([before?.outputs, before?.taps]) === JSON.stringify([now.outputs, now.taps]);

/**
 * Let a checked unit run from tick 0: on this bench where the signals are the same, else on a new one made of its scenario.
 *
 * Throws the refusal of the server.
 */
export async function runUnit(card: BlockCard, source: string): Promise<void> {
  const { bench } = useBench.getState();
  if (!bench) return;
  const { id, parameters } = bench;
  const drives = card.family === "control" && bench.controller === card.name;
  const values = valuesOf(card, source, drives, parameters);
  const isThere = sourceOnBench(parameters, card.name) !== undefined;
  if (isThere && isAlike(cardOf(card.family, card.name), card)) {
    await api.reset(id, values); // by a request, which waits while the text is compiled
    await shown(card.name, source);
    if (bench.state !== "running") await api.start(id);
  } else {
    const next = await api.variant(id, values);
    const isOurs = made === id && (bench.watchers ?? 0) <= 1;
    if (!isOurs && bench.state === "running" && (bench.watchers ?? 0) <= 1) await send({ kind: "pause" });
    if (next.state !== "running") await api.start(next.id);
    made = next.id;
    openOwn(next.id, isOurs);
    if (isOurs) await api.removeBench(id).catch(() => undefined); // it was closed elsewhere
    await shown(card.name, source);
  }
  announce(`${card.title} runs from tick 0.`);
}

/** Wait until the page has the bench with a text, or shows another. */
const shown = (name: string, source: string): Promise<void> =>
  untilBench(({ bench }) => sourceOnBench(bench?.parameters, name) === source, MOST_WAIT_MS);
