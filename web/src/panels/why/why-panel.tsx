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
import styles from "./why.module.css";
import { correctionLatex, densityLatex, floorLatex, posteriorLatex } from "./why-latex";
import { likeliest } from "./why-sentence";
import { WhyVerdict } from "./why-verdict";

const LAST_TICK = 2 ** 53;

/** Why a diagnoser believed what it did at one sample: residual, density, prior and posterior of every hypothesis. */
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
        {account && !refusal && <span className={styles.time}>{formatClock(account.time_ms)} s</span>}
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

/** A refusal as a sentence: what is said of the tick is said of this sample. */
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
    <div className={styles.explained} data-waiting={waiting}>
      <ModelTable account={account} chosen={chosen} onChoose={(i) => setName(account.models[i].name)} />
      <Box component="h2" m="12px 0 4px">
        {model.name} at this sample, in µm and ms{account.gain_units.length > 2 && ", the rate in deg/s"}
      </Box>
      {density && posterior ? (
        <ol className={styles.steps}>
          <li>
            <span>How well it predicted the measurement</span>
            <Formula latex={density} />
          </li>
          <li>
            <span>Weighed by {account.weighed}</span>
            <Formula latex={posterior} />
          </li>
          {floor && (
            <li>
              <span>The bank never drops a hypothesis</span>
              <Formula latex={floor} />
            </li>
          )}
          {correction && (
            <li>
              <span>How far its Kalman gain moves its state after the measurement</span>
              <Formula latex={correction} />
            </li>
          )}
        </ol>
      ) : (
        <Box component="p" c="dimmed">
          The filters learnt nothing from this sample: its residual is zero, and the record does not give its
          covariance.
        </Box>
      )}
    </div>
  );
}
