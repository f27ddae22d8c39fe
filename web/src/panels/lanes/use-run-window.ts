import { useEffect, useState } from "react";
import { api } from "../../api/api";
import { useAnswer } from "../../api/queries";
import { hasEnded, longestStep, useSteps } from "../../bench/steps";
import { useBench } from "../../stream/bench-store";
import { TIME_WINDOWS_MS } from "../../ui/time-axis";
import type { Span } from "../scope/use-time-view";

const USUAL_MS = 20;
/** A window holds a step and half a step before it. */
const AROUND = 1.5;

interface RunWindow {
  windowMs: number;
  /** The whole run, where the lanes show all of it. */
  whole: Span | undefined;
}

/**
 * The window that the lanes choose themselves: each step of a scenario whole while it first runs; the whole run from its
 * end on, also while its steps are replayed; the whole of a recording.
 */
export function useRunWindow(): RunWindow {
  const id = useBench((s) => s.bench?.id);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const end = useBench((s) => s.bench?.samples) ?? undefined;
  const steps = useSteps();
  const recorded = useRecordedSpan();
  const ended = useBench(({ bench }) => Boolean(end && bench && steps.length > 1 && hasEnded(bench, steps)));
  const [ranBench, setRanBench] = useState<string>();
  useEffect(() => {
    if (ended) setRanBench(id);
  }, [ended, id]);
  const step = useLeast(id, longestStep(steps, end));
  const hasRun = ended || (ranBench !== undefined && ranBench === id);
  const whole = recorded ?? (hasRun && end ? { start: 0, end } : undefined);
  return { windowMs: whole ? (whole.end - whole.start) * dtMs : usualWindow(step && step * dtMs), whole };
}

/** A window that shows each step of a scenario whole. */
function usualWindow(stepMs: number | undefined): number {
  if (!stepMs) return USUAL_MS;
  const windows = TIME_WINDOWS_MS.lanes;
  return windows.find((ms) => ms >= AROUND * stepMs) ?? windows[windows.length - 1];
}

/** The least length so far on a bench: for a moment, a step that is taken neither waits nor is in the log. */
function useLeast(id: string | undefined, length: number | undefined): number | undefined {
  const [least, setLeast] = useState({ id, length });
  const known = least.id === id ? least.length : undefined;
  const now = known === undefined || (length !== undefined && length < known) ? length : known;
  if (least.id !== id || now !== known) setLeast({ id, length: now });
  return now;
}

/** The ticks of the recording that the page plays. */
function useRecordedSpan(): Span | undefined {
  const id = useBench((s) => s.bench?.replay_of) ?? "";
  const { value } = useAnswer(id ? ["recording", id] : undefined, () => api.recording(id));
  return value && { start: value.start_tick, end: value.start_tick + value.ticks };
}
