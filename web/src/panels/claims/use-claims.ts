import { api } from "../../api/api";
import { type Answer, useAnswer, useLast } from "../../api/queries";
import type { ClaimList } from "../../api/types";
import { useRun } from "../../bench/printed";
import { useBench } from "../../stream/bench-store";
import { useBoardState } from "../../stream/freshness";

const EVERY_MS = 1000;

/** The claims of the bench on the page, measured anew while it runs and has not come to the end of its run. */
export function useClaims(): Answer<ClaimList> {
  const run = useRun();
  const id = useBench((s) => s.bench?.id) ?? "";
  const isRunning = useBoardState() === "running";
  const tick = useBench((s) => (s.bench?.state === "running" ? undefined : s.bench?.tick));
  const answer = useAnswer(
    run && ["claims", ...run, tick],
    () => api.claims(id),
    (found) => (isRunning || (found && tick !== undefined && isBehind(found, tick)) ? EVERY_MS : undefined),
  );
  const last = useLast(answer.value);
  return { ...answer, value: answer.value ?? (last?.bench_id === id ? last : undefined) };
}

/** Whether the server still measures samples of the past. */
const isBehind = ({ tick, ends_at, is_over, reason }: ClaimList, now: number): boolean =>
  reason === "" && !is_over && tick < Math.min(now, ends_at);
