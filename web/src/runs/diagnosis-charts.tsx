import { NativeSelect, Stack } from "@mantine/core";
import { useState } from "react";
import type { PointTally } from "../api/types";
import { LineChart } from "../picture/line-chart";
import { Confusion } from "../ui/confusion";
import { formatCount, formatShare } from "../ui/format";
import { delayLine, pointName } from "./points";
import styles from "./runs.module.css";

const MOST_LINES = 8;
const UNIT: [number, number] = [0, 1];

/** The verdicts of a diagnoser in all runs: operating characteristic and delays of the points, confusion of one point. */
export function DiagnosisCharts({ points, words }: { points: PointTally[]; words: Record<string, string> }) {
  const diagnosers = [...new Set(points.flatMap((point) => Object.keys(point.diagnosis ?? {})))];
  const [diagnoser, setDiagnoser] = useState<string | undefined>(undefined);
  const [at, setAt] = useState(0);
  const id = diagnoser ?? diagnosers[0];
  if (!id) return null;
  const found = points.flatMap((point) => {
    const tally = point.diagnosis?.[id];
    return tally ? [{ name: pointName(point.labels), tally }] : [];
  });
  const drawn = found.slice(0, MOST_LINES);
  const one = found[Math.min(at, found.length - 1)];
  return (
    <Stack component="section" gap={12} aria-label="Diagnosis">
      <div className={`row ${styles.links}`}>
        <h3>Diagnosis</h3>
        {diagnosers.length > 1 && (
          <NativeSelect
            aria-label="Diagnoser"
            value={id}
            data={diagnosers.map((name) => ({ value: name, label: words[name] ?? name }))}
            onChange={(e) => setDiagnoser(e.currentTarget.value)}
          />
        )}
        {found.length > MOST_LINES && (
          <span className="note">
            curves of the first {MOST_LINES} of {formatCount(found.length, "point")}
          </span>
        )}
      </div>
      <div className="plots">
        <LineChart
          title="Receiver operating characteristic, sample by sample"
          xLabel="share of false alarms"
          yLabel="share of detections"
          xRange={UNIT}
          yRange={UNIT}
          lines={drawn.flatMap(({ name, tally: { roc } }) =>
            roc ? [{ name: `${name} (area ${formatShare(roc.area)})`, x: roc.false_alarm, y: roc.detection }] : [],
          )}
        />
        <LineChart
          title="Detection delay"
          xLabel="delay, samples"
          yLabel="share found by then"
          yRange={UNIT}
          lines={drawn.map(({ name, tally }) => delayLine(name, tally))}
        />
      </div>
      {found.length > 1 && (
        <NativeSelect
          label="Confusion at"
          w="fit-content"
          value={String(at)}
          data={found.map(({ name }, i) => ({ value: String(i), label: name }))}
          onChange={(e) => setAt(Number(e.currentTarget.value))}
        />
      )}
      <div className="wide">
        <Confusion
          title={words[id] ?? id}
          names={one.tally.names.map((name) => words[name] ?? name)}
          counts={one.tally.confusion}
        />
      </div>
      {one.tally.missed > 0 && <p className="note">{one.tally.missed} changes were never found.</p>}
    </Stack>
  );
}
