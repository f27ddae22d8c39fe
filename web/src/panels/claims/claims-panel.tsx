import { Box, Checkbox } from "@mantine/core";
import { useState } from "react";
import type { ClaimList } from "../../api/types";
import { showPrinted, usePrinted } from "../../bench/printed";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatSi } from "../../ui/format";
import { Verdict } from "../../ui/verdict";
import { ClaimCard } from "./claim-card";
import { useClaims } from "./use-claims";

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
