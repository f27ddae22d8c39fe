import { Box, MultiSelect, Stack } from "@mantine/core";
import { useState } from "react";
import { api } from "../api/api";
import { useAnswer, useLast } from "../api/queries";
import type { PointTally, SweepRun } from "../api/types";
import { Downloads } from "../ui/downloads";
import { EmptyState } from "../ui/empty-state";
import { formatCount, formatNumber } from "../ui/format";
import { metricTitle } from "../ui/metric-name";
import { Stale } from "../ui/stale";
import { CampaignFigures } from "./campaign-figures";
import { DiagnosisCharts } from "./diagnosis-charts";
import { DistributionChart } from "./distribution-chart";
import { ReportButton, ScriptButton } from "./file-buttons";
import { isActive, sweepName } from "./jobs";
import { NameField } from "./name-field";
import { PointsTable } from "./points-table";
import styles from "./runs.module.css";
import { usePoints } from "./use-points";

/** Runs from which their distribution is worth a plot. */
const SOME_RUNS = 50;
const MOST_SAID = 4;
/** The number of columns of the table at first. */
const FIRST_COLUMNS = 4;

/** A campaign: its picture, the verdicts of each diagnoser, and its points as a table. */
export function CampaignDetail({ sweep, onChanged }: { sweep: SweepRun; onChanged(): void }) {
  const { value, error, since, again, isPage, every, ...paging } = usePoints(sweep);
  const [columns, setColumns] = useState<string[] | undefined>(undefined);
  const [chosen, setChosen] = useState<{ figure?: string; across?: string }>({});
  const { value: newest } = useAnswer(
    ["sweep picture", sweep.id, sweep.state, chosen],
    () => api.sweepPicture(sweep.id, chosen),
    () => every,
  );
  const picture = useLast(newest);
  const files = `./api/v1/sweeps/${sweep.id}`;
  const points = value?.points ?? [];
  const shown = columns ?? picture?.figures.slice(0, FIRST_COLUMNS) ?? [];

  return (
    <Stack component="article" className={styles.result} gap={12}>
      <header>
        <h2>{sweepName(sweep)}</h2>
        <small>
          {formatNumber(sweep.done ?? 0, 0)} of {formatCount(sweep.runs, "run")} · {sweep.state}
          {sweep.error && `: ${sweep.error.message}`}
        </small>
        <NameField
          label={sweep.label ?? ""}
          title={sweep.title || `Campaign ${sweep.name}`}
          save={(label) => api.renameSweep(sweep.id, label).then(onChanged)}
        />
      </header>
      <Stale error={error} since={since} onRetry={again} />
      {points.length === 0 ? (
        !error && (
          <EmptyState title={isActive(sweep.state) ? "No run is done yet" : "No result"}>
            The first results of a campaign appear here while it runs.
          </EmptyState>
        )
      ) : (
        <>
          <div className={`row ${styles.links}`}>
            <ReportButton files={files} title="One HTML file that needs nothing else" />
            <ScriptButton files={files} title="A script that repeats this campaign over REST" />
            <span>
              All runs <Downloads href={(format) => `${files}/runs?format=${format}`} formats={["csv", "parquet"]} />
            </span>
          </div>
          <Said points={points} />
          {picture && picture.parts.length > 0 && <CampaignFigures picture={picture} onChoose={setChosen} />}
          {(sweep.done ?? 0) >= SOME_RUNS && value && (
            <DistributionChart
              sweep={sweep}
              quantities={value.quantities}
              figures={value.figures}
              first={picture?.figure}
              every={every}
            />
          )}
          <DiagnosisCharts points={points} words={value?.words ?? {}} />
          <details open={picture?.parts.length === 0}>
            <Box component="summary" py={4} fz="sm" fw={600}>
              All points as a table
            </Box>
            <MultiSelect
              size="xs"
              label="Columns"
              searchable
              data={(picture?.figures ?? []).map((name) => ({ value: name, label: metricTitle(name) }))}
              value={shown}
              onChange={setColumns}
              maxDropdownHeight={300}
            />
            <PointsTable points={points} metrics={shown} found={value?.found ?? 0} isPage={isPage} {...paging} />
          </details>
        </>
      )}
    </Stack>
  );
}

/** The errors and the warnings of the runs, each text once. */
function Said({ points }: { points: PointTally[] }) {
  const errors = [...new Set(points.flatMap((point) => point.errors ?? []))].slice(0, MOST_SAID);
  const warnings = [...new Set(points.flatMap((point) => point.warnings ?? []))].slice(0, MOST_SAID);
  if (errors.length + warnings.length === 0) return null;
  return (
    <ul className="wrong">
      {[...errors, ...warnings.map((text) => `Warning: ${text}`)].map((text) => (
        <li key={text}>{text}</li>
      ))}
    </ul>
  );
}
