import { Box, Checkbox } from "@mantine/core";
import { useState } from "react";
import { api } from "../../api/api";
import { type Answer, useAnswer, useLast } from "../../api/queries";
import type { ClaimList } from "../../api/types";
import { showPrinted, usePrinted, useRun } from "../../bench/printed";
import { useBench } from "../../stream/bench-store";
import { useBoardState } from "../../stream/freshness";
import { EmptyState } from "../../ui/empty-state";
import { formatSi } from "../../ui/format";
import { Verdict } from "../../ui/verdict";
import { ClaimCard } from "./claim-card";

/** The claims of the scenario of the bench: printed, expected, and measured so far. */
export function ClaimsPanel() {
  const { value, error } = useClaims();
  const isShown = usePrinted((s) => s.isShown);
  const [open, setOpen] = useState<string | undefined>(undefined);
  if (!value)
    return (
      <EmptyState title={error ? "The claims cannot be measured" : "Measuring"}>
        {error?.body.message ?? "Printed, expected and measured figures appear here."}
      </EmptyState>
    );
  if (value.claims.length === 0)
    return (
      <EmptyState title="This experiment makes no claim">
        Open one of chapters 1 to 6 from the gallery: its printed figures appear here beside the measured ones.
      </EmptyState>
    );
  return (
    <Box
      component="section"
      className="view"
      p={12}
      fz="sm"
      style={{ gap: 8 }}
      aria-label="Claims"
      data-over={value.is_over}
    >
      <Box component="header" flex="none">
        <Box component="p" m="0 0 6px" fz="md" fw={620}>
          {value.claim || value.title}
        </Box>
        <div className="row">
          {value.is_over && <Verdict verdict={value.verdict} borneOut />}
          <Box component="span" flex="1 1 220px" c="dimmed">
            <Progress list={value} />
          </Box>
          <Checkbox
            label="Printed marks on the scopes"
            checked={isShown}
            onChange={(event) => showPrinted(event.currentTarget.checked)}
          />
        </div>
      </Box>
      <ul className="column">
        {value.claims.map((claim) => (
          <ClaimCard
            key={claim.metric}
            claim={claim}
            list={value}
            isOpen={open === claim.metric}
            onOpen={(isOpen) => setOpen(isOpen ? claim.metric : undefined)}
          />
        ))}
      </ul>
    </Box>
  );
}

/** The measured part of the run, and the moment of judgement. */
function Progress({ list: { tick, ends_at, is_over, reason } }: { list: ClaimList }) {
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  if (reason) return <>Not measured: {reason}.</>;
  if (is_over) return <>Measured over the whole run, {formatSi(tick * dtMs, "ms")}.</>;
  return (
    <>
      Measured over {formatSi(tick * dtMs, "ms")} of {formatSi(ends_at * dtMs, "ms")}; judged at the end.
    </>
  );
}

const EVERY_MS = 1000;

/** The claims of the bench on the page, measured anew while it runs and has not come to the end of its run. */
function useClaims(): Answer<ClaimList> {
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
