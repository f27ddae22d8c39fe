import { useCallback, useEffect, useState } from "react";
import { ApiError } from "../../api/client";
import { runUnit } from "../../bench/run-unit";
import { isUnitName, noteVersion, useDraft } from "../../bench/unit-draft";
import { sourceOnBench } from "../../bench/unit-values";
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
