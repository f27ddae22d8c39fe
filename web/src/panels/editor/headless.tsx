import { Box, Button } from "@mantine/core";
import { useState } from "react";
import { api } from "../../api/api";
import { useAnswer } from "../../api/queries";
import type { BlockCard, NewRun, Run } from "../../api/types";
import { valuesOf } from "../../bench/unit-values";
import { useBusy } from "../../bench/use-busy";
import { openPlace } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { Figure } from "../../ui/figure";
import { metricScale } from "../../ui/metric-name";
import styles from "./editor.module.css";

const BUSY_MS = 300;

/** A headless run of the bench's scenario with the unit: its digest, and its figures. */
export function Headless({ card, source, ready }: { card: BlockCard; source: string; ready: boolean }) {
  const scenario = useBench((s) => s.bench?.scenario_id);
  const [started, setStarted] = useState<{ id: string; source: string } | undefined>(undefined);
  const id = started?.id;
  const [busy, during] = useBusy();
  const { value: run } = useAnswer(
    id === undefined ? undefined : ["run", id],
    () => api.run(id ?? ""),
    (found) => (isOver(found) ? undefined : BUSY_MS),
  );
  const start = () =>
    during(async () => {
      const { id } = await api.startRun(await wanted(card, source));
      setStarted({ id, source });
    });
  return (
    <section aria-label="Headless run">
      <h3>Headless run</h3>
      <Box component="p" className="note" mb={6}>
        {scenario} from its start to its end{card.family === "control" && `, ${card.title} drives`}.
      </Box>
      <Button loading={busy || (run && !isOver(run))} disabled={!ready} onClick={() => void start()}>
        Use in a run
      </Button>
      {run && started?.source !== source && (
        <Box component="p" className="note" mb={6}>
          These figures are of an earlier text.
        </Box>
      )}
      {run && isOver(run) && <Outcome run={run} card={card} />}
    </section>
  );
}

const isOver = (run: Run | undefined): boolean => run !== undefined && !["queued", "running"].includes(run.state);

/** The scenario of the library, or the events of the bench where the library has no such scenario. */
async function wanted(card: BlockCard, source: string): Promise<NewRun> {
  const { bench } = useBench.getState();
  if (!bench) throw new Error("there is no bench");
  const isOfLibrary = (await api.scenarios()).some((one) => one.id === bench.scenario_id);
  const scenario = isOfLibrary ? bench.scenario_id : await api.scenarioToml(bench.id);
  const set = valuesOf(card, source, isOfLibrary && card.family === "control");
  return { scenario, set, label: `${card.title} on ${bench.scenario_id}`.slice(0, 120), all: false };
}

/** The beginning of the names of the figures of a family. */
const figuresOf = ({ family, name }: BlockCard): string =>
  family === "diagnose" ? `diagnosis.${name}.` : family === "identify" ? `identify.${name}.` : "control.";

function Outcome({ run, card }: { run: Run; card: BlockCard }) {
  const digest = run.summary?.digest;
  const figures = Object.entries(run.summary?.metrics ?? {}).filter(([name]) => name.startsWith(figuresOf(card)));
  return (
    <>
      <dl className={styles.list}>
        {figures.map(([name, value]) => {
          const { name: words, say } = metricScale(name, []);
          return (
            <Figure key={name} name={words}>
              {say(value)}
            </Figure>
          );
        })}
        <Figure name="Digest" className={styles.digest}>
          {digest ?? run.state}
        </Figure>
      </dl>
      <Button variant="subtle" onClick={() => openPlace("runs", run.id)}>
        Open under Runs
      </Button>
    </>
  );
}
