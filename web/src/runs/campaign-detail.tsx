import { MultiSelect } from "@mantine/core";
import { useState } from "react";
import { api } from "../api/api";
import { micro } from "../api/micro";
import type { PointTally, SweepRun } from "../api/types";
import { LineChart } from "../picture/line-chart";
import { Downloads } from "../ui/downloads";
import { EmptyState } from "../ui/empty-state";
import { formatCount, formatNumber } from "../ui/format";
import { metricLimits, metricScale, metricTitle } from "../ui/metric-name";
import { Stale } from "../ui/stale";
import { DiagnosisCharts } from "./diagnosis-charts";
import { DistributionChart } from "./distribution-chart";
import { ReportButton, ScriptButton } from "./file-buttons";
import { sweepName } from "./jobs";
import { NameField } from "./name-field";
import { labelScale, numericAxes, trend, usualMetrics } from "./points";
import { PointsTable } from "./points-table";
import styles from "./runs.module.css";
import { usePoints } from "./use-points";

/** Runs from which their distribution is worth a plot. */
const SOME_RUNS = 50;
const MOST_TRENDS = 6;
const MOST_SAID = 4;

/** A campaign: its points as a table, figures over what was varied, and what each diagnoser said. */
export function CampaignDetail({ sweep, onChanged }: { sweep: SweepRun; onChanged(): void }) {
  const active = sweep.state === "queued" || sweep.state === "running";
  const { value, error, since, again, isPage, every, ...paging } = usePoints(sweep);
  const [metrics, setMetrics] = useState<string[] | undefined>(undefined);
  const files = `./api/v1/sweeps/${sweep.id}`;
  const points = value?.points ?? [];
  const shown = metrics ?? usualMetrics(points);

  const spread = (sweep.done ?? 0) >= SOME_RUNS && value && (
    <DistributionChart
      sweep={sweep}
      quantities={value.quantities}
      figures={value.figures}
      first={shown[0]}
      every={every}
    />
  );

  return (
    <article className={styles.result}>
      <header>
        <h2>{sweepName(sweep)}</h2>
        <small>
          {formatNumber(sweep.done ?? 0, 0)} of {formatCount(sweep.runs, "run")} · {sweep.state}
          {sweep.error && `: ${String(sweep.error.message)}`}
        </small>
        <NameField
          label={sweep.label ?? ""}
          title={micro(sweep.title) || `Campaign ${sweep.name}`}
          save={(label) => api.renameSweep(sweep.id, label).then(onChanged)}
        />
      </header>
      <Stale error={error} since={since} onRetry={again} />
      {points.length === 0 ? (
        !error && (
          <EmptyState title={active ? "No run is done yet" : "No result"}>
            The first results of a campaign appear here while it runs.
          </EmptyState>
        )
      ) : (
        <>
          <div className={styles.links}>
            <ReportButton files={files} title="One HTML file that needs nothing else" />
            <ScriptButton files={files} title="A script that repeats this campaign over REST" />
            <span>
              All runs <Downloads href={(format) => `${files}/runs?format=${format}`} formats={["csv", "parquet"]} />
            </span>
          </div>
          <Said points={points} />
          <MultiSelect
            size="xs"
            label="Figures"
            searchable
            data={(value?.figures ?? []).map((name) => ({ value: name, label: metricTitle(name) }))}
            value={shown}
            onChange={setMetrics}
            maxDropdownHeight={300}
          />
          {isPage && spread}
          <PointsTable points={points} metrics={shown} found={value?.found ?? 0} isPage={isPage} {...paging} />
          {!isPage && <Trends points={points} metrics={shown} />}
          {!isPage && spread}
          <DiagnosisCharts points={points} />
        </>
      )}
    </article>
  );
}

/** What runs could not do, and what they warn of, each text once. */
function Said({ points }: { points: PointTally[] }) {
  const errors = [...new Set(points.flatMap((point) => point.errors ?? []))].slice(0, MOST_SAID);
  const warnings = [...new Set(points.flatMap((point) => point.warnings ?? []))].slice(0, MOST_SAID);
  if (errors.length + warnings.length === 0) return null;
  return (
    <ul className={styles.refusal}>
      {[...errors, ...warnings.map((text) => `Warning: ${text}`)].map((text) => (
        <li key={text}>{micro(text)}</li>
      ))}
    </ul>
  );
}

function Trends({ points, metrics }: { points: PointTally[]; metrics: string[] }) {
  const charts = numericAxes(points)
    .flatMap((axis) => metrics.map((metric) => ({ axis, metric, lines: trend(points, axis, metric) })))
    .slice(0, MOST_TRENDS);
  if (charts.length === 0) return null;
  return (
    <div className={styles.charts}>
      {charts.map(({ axis, metric, lines }) => {
        const across = labelScale(
          axis,
          lines.flatMap(({ x }) => x),
        );
        const up = metricScale(
          metric,
          lines.flatMap(({ y }) => y),
        );
        return (
          <LineChart
            key={axis + metric}
            title={`${up.name} over ${metricScale(axis, []).name}`}
            xLabel={across.title}
            yLimits={metricLimits(metric)}
            yLabel={["mean ± std", up.unit].filter(Boolean).join(", ")}
            lines={lines.map((line) => ({
              ...line,
              x: line.x.map(across.shown),
              y: line.y.map(up.shown),
              spread: line.spread?.map(up.shown),
            }))}
          />
        );
      })}
    </div>
  );
}
