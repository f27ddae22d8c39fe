import { Box, MultiSelect, NativeSelect } from "@mantine/core";
import { useState } from "react";
import { api } from "../api/api";
import { useAnswer } from "../api/queries";
import type { Benchmark } from "../api/types";
import { useCatalog } from "../api/use-catalog";
import { PageHead } from "../bench/page-head";
import { LineChart } from "../picture/line-chart";
import { EmptyState } from "../ui/empty-state";
import { formatNumber } from "../ui/format";
import { Stale } from "../ui/stale";
import { delayLines, reliabilityLines } from "./curves";
import { ResultsTable } from "./results-table";

const SHARE: [number, number] = [0, 1];
/** Diagnosers that are drawn at first: the best. */
const DRAWN = 4;
const ID = "mems-diag-1";

/** The speed of the diagnosers, the causes they name, and the calibration of their probabilities. */
export function BenchmarkPage() {
  const { value, error, since, again } = useAnswer(["benchmark"], () => api.benchmark(ID));
  const [track, setTrack] = useState("known");
  const chosen = value?.results.find((one) => one.id === track);
  return (
    <div className="paper">
      <header className="card page-top">
        <PageHead name="Scores" heading="Benchmark" />
        {value && (
          <NativeSelect
            aria-label="Track"
            value={track}
            data={value.results.map(({ id, title }) => ({ value: id, label: title }))}
            onChange={(e) => setTrack(e.currentTarget.value)}
          />
        )}
        <Stale error={error} since={since} onRetry={again} />
      </header>
      {value && chosen ? (
        <Track key={chosen.id} track={chosen} benchmark={value} />
      ) : (
        !error && <EmptyState title="Opening the benchmark">The table comes from the server.</EmptyState>
      )}
    </div>
  );
}

/** The question of a track, its table and its curves. */
function Track({ track, benchmark }: { track: Benchmark["results"][number]; benchmark: Benchmark }) {
  const [units, setUnits] = useState(track.rows.slice(0, DRAWN).map((row) => row.unit));
  const drawn = track.rows.filter((row) => units.includes(row.unit));
  const { blocks } = useCatalog();
  const named = (unit: string) =>
    blocks.find(({ family, name }) => family === "diagnose" && name === unit)?.title ?? unit.replaceAll("_", " ");
  const out = benchmark.left_out.filter((one) => one.track === track.id);
  return (
    <>
      <section className="card essay" aria-label={track.title}>
        <h2>{track.question}</h2>
        <Box component="p" className="note" maw="100ch">
          {track.note}
        </Box>
        <ResultsTable named={named} rows={track.rows} costs={benchmark.costs} label={`Results of ${track.title}`} />
        <Box component="p" className="note" maw="100ch">
          {formatNumber(benchmark.cases, 0)} cases from public seeds; thresholds give one false alarm in{" "}
          {formatNumber(benchmark.false_alarm_samples, 0)} healthy samples on average. Ranked by log score, then by
          Brier score. Diagnosers without probabilities have no rank.
          {out.map((one) => ` ${named(one.unit)} is not scored: it ${one.reason}.`)} <code>{benchmark.command}</code>{" "}
          computes the table again, to the bit; the times are those of the machine that computed it, with their ratio to
          the Kalman bank.
        </Box>
      </section>
      <section className="card essay" aria-label="Curves">
        <MultiSelect
          size="xs"
          label="Diagnosers drawn"
          value={units}
          data={track.rows.map(({ unit }) => ({ value: unit, label: named(unit) }))}
          onChange={setUnits}
          maw={640}
        />
        <Box className="plots" mt={12}>
          <LineChart
            title="Reliability: below the diagonal, a diagnoser is surer than right"
            xLabel="probability said"
            yLabel="share that was right"
            xRange={SHARE}
            yRange={SHARE}
            lines={reliabilityLines(drawn, named)}
          />
          <LineChart
            title="Faults found"
            xLabel="samples since the fault"
            yLabel="share found by then"
            yRange={SHARE}
            lines={delayLines(drawn, benchmark.within_samples, named)}
          />
        </Box>
      </section>
    </>
  );
}
