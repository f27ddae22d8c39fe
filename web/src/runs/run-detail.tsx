import { Box, Button, Stack } from "@mantine/core";
import { IconPlayerPlay } from "@tabler/icons-react";
import { api } from "../api/api";
import type { GalleryCard, Run } from "../api/types";
import { openOwn } from "../bench/open-bench";
import { showError } from "../bench/send";
import { setPage } from "../bench/view-store";
import { ExpectationTable } from "../gallery/expectation-table";
import { Downloads, TRACE_FORMATS } from "../ui/downloads";
import { EmptyState } from "../ui/empty-state";
import { formatBeside, formatCount, formatFigure, formatPercent, formatShort, formatSi } from "../ui/format";
import { metricScale } from "../ui/metric-name";
import { TableHead } from "../ui/table-head";
import { ReportButton, ScriptButton } from "./file-buttons";
import { runName } from "./jobs";
import { NameField } from "./name-field";
import { OwnValues } from "./own-values";
import styles from "./runs.module.css";

const DIGITS = 6;

/** The summary of a run, as `combbench run --json` prints it. */
interface Summary {
  seed: number;
  seeds?: number[];
  ticks: number;
  dt_s: number;
  elapsed_s: number;
  digest: string;
  verdict: string | null;
  claim: string;
  trip: { reason: string; time_ms: number } | null;
  warnings: string[];
  metrics: Record<string, number>;
  metrics_std?: Record<string, number>;
  expectations: GalleryCard["expectations"];
}

/** One run: the expected and measured values, every figure, and its files. */
export function RunDetail({ run, onChanged }: { run: Run; onChanged(): void }) {
  const files = `./api/v1/runs/${run.id}`;
  const summary = run.summary as Summary | null;
  if (!summary)
    return (
      <EmptyState title={UNDONE[run.state] ?? run.state}>
        {run.error?.message ??
          (run.state === "cancelled"
            ? "Start it again to have its result."
            : `${formatPercent(run.progress, 0)} done.`)}
      </EmptyState>
    );
  const live = () =>
    api.createBench({ scenario: run.scenario_id, seed: run.seeds[0], paused: false }).then(({ id }) => {
      openOwn(id);
      setPage("bench");
    }, showError);
  const hasTrace = summary.ticks > 0;
  return (
    <Stack component="article" className={styles.result} gap={12}>
      <header>
        <h2>{runName(run)}</h2>
        <small>
          {run.scenario_id} ·{" "}
          {run.seeds.length > 1 ? `seeds ${run.seeds[0]} to ${run.seeds.at(-1)}` : `seed ${run.seeds[0]}`}
          {hasTrace && ` · ${formatCount(summary.ticks, "tick")} of ${formatShort(summary.dt_s, "s")}`} · took{" "}
          {formatSi(summary.elapsed_s, "s", 3)}
        </small>
        <p className="note">
          <OwnValues run={run} />
        </p>
        <NameField
          label={run.label ?? ""}
          title={run.title || run.scenario_id}
          save={(label) => api.renameRun(run.id, label).then(onChanged)}
        />
        {summary.trip && <p className="wrong">Tripped: {summary.trip.reason}</p>}
        {summary.warnings.map((text) => (
          <p key={text} className="wrong">
            Warning: {text}
          </p>
        ))}
      </header>
      <div className={`row ${styles.overview}`}>
        <img src={`${files}/thumbnail`} alt={`Figure of ${runName(run)}`} />
        <div className={`row ${styles.links}`}>
          <ReportButton files={files} />
          <ScriptButton files={files} title="A script that repeats this run over REST and checks its bits" />
          {hasTrace && (
            <Button
              size="xs"
              leftSection={<IconPlayerPlay size={15} />}
              title="The scenario as the library has it, on a live bench"
              onClick={live}
            >
              Scenario on the bench
            </Button>
          )}
          {hasTrace && (
            <span>
              Trace{run.seeds.length > 1 && " of the first seed"}{" "}
              <Downloads href={(format) => `${files}/trace?format=${format}`} formats={TRACE_FORMATS} />
            </span>
          )}
        </div>
      </div>
      {summary.expectations.length > 0 && (
        <>
          <h3>Expectations</h3>
          {summary.claim && <p className="note">Claim: {summary.claim}.</p>}
          <ExpectationTable entries={summary.expectations} verdict={summary.verdict} />
        </>
      )}
      <h3>Figures</h3>
      <table className={`numbers ${styles.table}`}>
        <TableHead names={["figure", summary.metrics_std ? "mean" : "value", Boolean(summary.metrics_std) && "std"]} />
        <tbody>
          {Object.entries(summary.metrics).map(([name, value]) => {
            const { title, shown } = metricScale(name, [value]);
            const std = summary.metrics_std?.[name] ?? 0;
            return (
              <tr key={name}>
                <th scope="row" title={name}>
                  {title}
                </th>
                <td>{formatFigure(name, shown(value), DIGITS)}</td>
                {summary.metrics_std && <td>{formatBeside(shown(std), shown(value), DIGITS)}</td>}
              </tr>
            );
          })}
        </tbody>
      </table>
      {summary.digest && (
        <Box
          component="p"
          className="remark"
          title="SHA-256 over the trace: the same from page, command line and script"
          style={{ overflowWrap: "anywhere" }}
        >
          digest {summary.digest}
        </Box>
      )}
    </Stack>
  );
}

const UNDONE: Record<string, string> = {
  queued: "It waits for its turn",
  running: "It is running",
  failed: "It could not be carried out",
  cancelled: "It was cancelled",
  aborted: "It was given up",
};
