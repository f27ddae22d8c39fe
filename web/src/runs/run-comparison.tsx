import { Checkbox, Select, Stack } from "@mantine/core";
import { useState } from "react";
import { api } from "../api/api";
import { useAnswer } from "../api/queries";
import type { RunComparison as Comparison } from "../api/types";
import { LineChart } from "../picture/line-chart";
import { EmptyState } from "../ui/empty-state";
import { formatBeside, formatCount, formatFigure } from "../ui/format";
import { metricScale } from "../ui/metric-name";
import { Stale } from "../ui/stale";
import { TableHead } from "../ui/table-head";
import { unitText } from "../ui/unit-scale";
import { runName, seedText } from "./jobs";
import styles from "./runs.module.css";

const DIGITS = 6;
const USUAL = ["plant.displacement", "plant.x"];
/** Finished runs side by side: their figures with the difference from the first, a signal of all over each other. */
export function RunComparison({ ids }: { ids: string }) {
  const { value, error, since, again } = useAnswer(["compare", ids], () => api.compareRuns(ids.split(",")));
  const [onlyDifferent, setOnlyDifferent] = useState(true);
  if (!value)
    return error ? (
      <Stale error={error} since={since} onRetry={again} />
    ) : (
      <EmptyState title="Comparing">Figures and traces come from the server.</EmptyState>
    );
  const names = namesOf(value);
  const different = value.figures.filter((row) => row.differences.some((one) => one !== 0));
  const rows = onlyDifferent ? different : value.figures;
  return (
    <Stack component="article" className={styles.result} gap={12} aria-label="Comparison">
      <h2>{formatCount(value.runs.length, "run")} side by side</h2>
      <Traces ids={ids} comparison={value} names={names} />
      <Checkbox
        label={`Only the ${formatCount(different.length, "figure")} that differ`}
        checked={onlyDifferent}
        onChange={(e) => setOnlyDifferent(e.currentTarget.checked)}
      />
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: a table that scrolls is reached by the keyboard */}
      <section className="wide" tabIndex={0} aria-label="Figures of the runs">
        <table className={`numbers ${styles.table}`}>
          <TableHead
            names={[
              "figure",
              ...names,
              ...names.slice(1).map((name) => (names.length > 2 ? `${name}: difference` : "difference")),
            ]}
          />
          <tbody>
            {rows.map(({ metric, values, differences }) => {
              const { title, shown } = metricScale(metric, values);
              const largest = Math.max(...values.map((one) => Math.abs(shown(one ?? 0))));
              return (
                <tr key={metric}>
                  <th scope="row" title={metric}>
                    {title}
                  </th>
                  {values.map((one, i) => (
                    <td key={value.runs[i].id}>{formatFigure(metric, one && shown(one), DIGITS)}</td>
                  ))}
                  {differences.slice(1).map((one, i) => (
                    <td key={value.runs[i + 1].id} data-differs={one !== null && one !== 0}>
                      {differenceText(one && shown(one), largest)}
                    </td>
                  ))}
                </tr>
              );
            })}
          </tbody>
        </table>
      </section>
    </Stack>
  );
}

/** A signal that all runs have, of all of them over each other. */
function Traces({ ids, comparison, names }: { ids: string; comparison: Comparison; names: string[] }) {
  const { signals, runs } = comparison;
  const first = USUAL.find((name) => signals.some((one) => one.name === name)) ?? signals[0]?.name ?? "";
  const [signal, setSignal] = useState(first);
  const { value, error, since, again } = useAnswer(signal ? ["compare", ids, signal] : undefined, () =>
    api.compareTraces(ids.split(","), signal ?? ""),
  );
  if (!signal) return <p className="note">One of them is a study, which leaves no trace.</p>;
  return (
    <>
      <Select
        label="Signal"
        searchable
        allowDeselect={false}
        w={280}
        value={signal}
        data={signals.map((one) => one.name)}
        onChange={(name) => name && setSignal(name)}
      />
      <Stale error={error} since={since} onRetry={again} />
      <div className="plots">
        {value && (
          <LineChart
            title={value.signal}
            xLabel="time, ms"
            yLabel={[value.signal.split(".").at(-1), unitText(value.unit)].filter(Boolean).join(", ")}
            lines={value.runs.map((one, i) => ({ name: names[i] ?? runs[i].id, x: one.time_ms, y: one.values }))}
          />
        )}
      </div>
    </>
  );
}

/** Names that tell the runs apart: with the seed, and with a part of the id where that is not enough. */
function namesOf({ runs }: Comparison): string[] {
  const short = runs.map(runName);
  const seeded = runs.map((run, i) =>
    short.indexOf(short[i]) === short.lastIndexOf(short[i]) ? short[i] : `${short[i]}, ${seedText(run)}`,
  );
  return seeded.map((name, i) =>
    seeded.indexOf(name) === seeded.lastIndexOf(name) ? name : `${name}, ${runs[i].id.slice(0, 6)}`,
  );
}

function differenceText(difference: number | null, figure: number): string {
  if (difference === null) return "–";
  if (difference === 0) return "same";
  const text = formatBeside(difference, figure, DIGITS);
  return difference > 0 && !text.startsWith("<") ? `+${text}` : text;
}
