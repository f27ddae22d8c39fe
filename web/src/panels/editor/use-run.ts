import { useCallback, useEffect, useState } from "react";
import { api } from "../../api/api";
import { ApiError } from "../../api/client";
import type { BlockCard } from "../../api/types";
import { cardOf } from "../../api/use-catalog";
import { announce } from "../../bench/announce";
import { openOwn } from "../../bench/open-bench";
import { send } from "../../bench/send";
import { isUnitName, noteVersion, useDraft } from "../../bench/unit-draft";
import { sourceOnBench, valuesOf } from "../../bench/unit-values";
import { untilBench } from "../../bench/until-bench";
import { useBench } from "../../stream/bench-store";
import type { Check } from "./use-check";

/** Pause after a check that passed until the text runs. */
const PAUSE_MS = 300;

export interface Run {
  /** The bench of the page runs the text of now. */
  isOn: boolean;
  busy: boolean;
  /** Why the bench stopped while the unit drove. */
  trip: string | undefined;
  /** Why the bench did not take the text. */
  refusal: string | undefined;
  start(): void;
}

/** Lets a text that passes run on the bench, by itself after a pause in typing. */
export function useRun(check: Check | undefined): Run {
  const { name, source, asYouType, tried } = useDraft();
  const isOn = useBench((s) => sourceOnBench(s.bench?.parameters, name) === source);
  const reason = useBench((s) => s.bench?.trip?.reason);
  const drives = useBench((s) => Object.values(s.bench?.slots ?? {}).includes(name));
  const [busy, setBusy] = useState(false);
  const [refused, setRefused] = useState<{ source: string; why: string } | undefined>(undefined);
  const card = isUnitName(name) && check?.name === name ? check.unit?.card : undefined;

  const start = useCallback(async () => {
    if (!card) return;
    setBusy(true);
    useDraft.setState({ tried: source });
    try {
      await runUnit(card, source);
      if (!useBench.getState().bench?.trip) noteVersion(name, source, "ran");
      setRefused(undefined);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      noteVersion(name, source, "refused");
      setRefused({ source, why: error.body.message });
    } finally {
      setBusy(false);
    }
  }, [card, name, source]);

  useEffect(() => {
    if (!asYouType || !card || isOn || busy || tried === source) return;
    const timer = setTimeout(() => void start(), PAUSE_MS);
    return () => clearTimeout(timer);
  }, [asYouType, card, isOn, busy, tried, source, start]);

  const trip = isOn && drives ? reason : undefined;
  useEffect(() => {
    if (trip !== undefined) noteVersion(name, source, "tripped");
  }, [trip, name, source]);

  return {
    isOn,
    busy,
    trip,
    refusal: refused?.source === source ? refused.why : undefined,
    start: () => void start(),
  };
}

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
async function runUnit(card: BlockCard, source: string): Promise<void> {
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
