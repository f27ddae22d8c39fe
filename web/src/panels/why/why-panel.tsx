import { ActionIcon, Box, Button, NativeSelect } from "@mantine/core";
import { IconChevronLeft, IconChevronRight } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../../api/api";
import { usePanelVisible } from "../../api/panel-visible";
import { useAsked } from "../../api/queries";
import type { Account, ApiErrorBody } from "../../api/types";
import { useView } from "../../bench/view-store";
import { askLatest, pickSample } from "../../bench/why";
import { useBench } from "../../stream/bench-store";
import { sentence } from "../../ui/capital";
import { EmptyState } from "../../ui/empty-state";
import { formatClock } from "../../ui/format";
import { Formula } from "../../ui/formula";
import { useRestingTick } from "../../ui/hover";
import { NumberField } from "../../ui/number-field";
import { ModelTable } from "./model-table";
import { correctionLatex, densityLatex, floorLatex, posteriorLatex } from "./why-latex";
import { likeliest } from "./why-sentence";
import { WhyVerdict } from "./why-verdict";

const LAST_TICK = 2 ** 53;

/** The reasons of a verdict at one sample: residual, density, prior and posterior of every hypothesis. */
export function WhyPanel() {
  const bench = useBench((s) => s.bench?.id);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const picked = useView((s) => s.sample);
  const rested = useRestingTick(usePanelVisible());
  const isKept = useBench((s) => rested !== undefined && rested > (s.bench?.first_tick ?? 0));
  const tick = isKept ? rested : picked?.tick;
  const sample = picked && tick !== undefined ? { ...picked, tick } : undefined;
  const {
    answer: account,
    refusal,
    waiting,
  } = useAsked(bench && sample ? ["explanation", bench, sample.diagnoser, sample.tick] : undefined, () =>
    api.explanation(bench ?? "", sample?.diagnoser ?? "", sample?.tick ?? 0),
  );
  const { answer: turn } = useAsked(
    account && sample && !refusal ? ["turn", bench, sample.diagnoser, account.tick] : undefined,
    () => api.turn(bench ?? "", sample?.diagnoser ?? "", account?.tick ?? 0),
  );
  const ids = Object.entries(diagnosers ?? {}).flatMap(([id, { names }]) => (names.length ? [id] : []));
  const latest = (
    <Button variant="filled" size="xs" disabled={ids.length === 0} onClick={askLatest}>
      Explain the latest sample
    </Button>
  );
  if (!sample || ids.length === 0)
    return (
      <EmptyState title="No sample chosen" action={ids.length > 0 && latest}>
        {ids.length > 0
          ? "Click anywhere in the lanes of Diagnosis: the numbers behind that sample appear here."
          : "This bench has no diagnoser that weighs hypotheses."}
      </EmptyState>
    );

  return (
    <section className="view-page" aria-label="Why">
      {account && !refusal && <WhyVerdict diagnoser={sample.diagnoser} account={account} turn={turn} />}
      <Box className="row" pb={8}>
        <NativeSelect
          aria-label="Diagnoser"
          value={sample.diagnoser}
          data={ids.map((id) => ({ value: id, label: id.replaceAll("_", " ") }))}
          onChange={(e) => pickSample(e.currentTarget.value, sample.tick)}
        />
        <Box component="span" className="line" flex="0 1 auto" miw={0}>
          <ActionIcon
            variant="default"
            size={28}
            aria-label="Sample before"
            onClick={() => pickSample(sample.diagnoser, sample.tick - 1)}
          >
            <IconChevronLeft size={16} />
          </ActionIcon>
          <NumberField
            label="Sample"
            unit=""
            integer
            minimum={0}
            maximum={LAST_TICK}
            value={sample.tick}
            onCommit={(tick) => pickSample(sample.diagnoser, tick)}
          />
          <ActionIcon
            variant="default"
            size={28}
            aria-label="Sample after"
            onClick={() => pickSample(sample.diagnoser, sample.tick + 1)}
          >
            <IconChevronRight size={16} />
          </ActionIcon>
        </Box>
        {account && !refusal && (
          <Box component="span" flex={1} c="dimmed" style={{ whiteSpace: "nowrap" }}>
            {formatClock(account.time_ms)} s
          </Box>
        )}
        <Button onClick={askLatest}>Latest</Button>
      </Box>
      {refusal && (
        <EmptyState title={inWords(refusal.body, sample.tick)} action={latest}>
          {refusal.body.hint || "Choose another sample, or another diagnoser."}
        </EmptyState>
      )}
      {account && !refusal && <Explained account={account} waiting={waiting} />}
    </section>
  );
}

/** A refusal as a sentence about this sample. */
function inWords({ field, message }: ApiErrorBody, tick: number): string {
  const said = message.replace(`${field}: `, "");
  return field === "tick" ? `Sample ${tick} ${said}.` : sentence(said);
}

function Explained({ account, waiting }: { account: Account; waiting: boolean }) {
  const [name, setName] = useState<string | undefined>(undefined);
  const wanted = account.models.findIndex((m) => m.name === name);
  const chosen = wanted >= 0 ? wanted : account.models.indexOf(likeliest(account.models));
  const model = account.models[chosen];
  const density = densityLatex(account.evidence, model);
  const posterior = posteriorLatex(account, chosen);
  const floor = floorLatex(account, chosen);
  const correction = correctionLatex(model);
  return (
    <Box opacity={waiting ? 0.6 : undefined}>
      <ModelTable account={account} chosen={chosen} onChoose={(i) => setName(account.models[i].name)} />
      <Box component="h2" m="12px 0 4px">
        {model.name} at this sample, in µm and ms{account.gain_units.length > 2 && ", the rate in deg/s"}
      </Box>
      {density && posterior ? (
        <ol>
          <Step title="How well it predicted the measurement" latex={density} />
          <Step title={`Weighed by ${account.weighed}`} latex={posterior} />
          {floor && <Step title="The bank never drops a hypothesis" latex={floor} />}
          {correction && (
            <Step title="How far its Kalman gain moves its state after the measurement" latex={correction} />
          )}
        </ol>
      ) : (
        <Box component="p" c="dimmed">
          The filters learnt nothing from this sample: its residual is zero, and the record does not give its
          covariance.
        </Box>
      )}
    </Box>
  );
}

function Step({ title, latex }: { title: string; latex: string }) {
  return (
    <li>
      <Box component="span" className="remark" display="block" mt={4}>
        {title}
      </Box>
      <Formula latex={latex} />
    </li>
  );
}
