import type { DiagnosisTally, PointTally } from "../api/types";
import type { ChartLine } from "../picture/paint-lines";
import { formatShort } from "../ui/format";
import { type MetricScale, metricScale } from "../ui/metric-name";

/** How the values of an axis are shown, by the end of its path. */
export const labelScale = (path: string, values: readonly (string | number | undefined)[]): MetricScale =>
  metricScale(
    path.split(".").at(-1) ?? path,
    values.filter((value) => typeof value === "number"),
  );

/** A value by which points differ; a number in the digits that distinguish it. */
export const labelText = (value: string | number, shown = (number: number) => number) =>
  typeof value === "number" ? formatShort(shown(value), "") : value;

/** The name of a point: the values by which it differs. */
export function pointName(labels: PointTally["labels"]): string {
  const parts = Object.entries(labels).map(([path, value]) => {
    if (path === "variant") return labelText(value);
    const { name, unit, shown } = labelScale(path, [value]);
    return `${name} ${labelText(value, shown)}${unit ? `\u00a0${unit}` : ""}`;
  });
  return parts.join(", ") || "all runs";
}

/** The share of changes found within so many samples; missed changes keep it below 1. */
export function delayLine(name: string, tally: DiagnosisTally): ChartLine {
  const entries = Object.entries(tally.delays)
    .map(([delay, count]) => [Number(delay), count] as const)
    .sort((a, b) => a[0] - b[0]);
  const total = entries.reduce((sum, [, count]) => sum + count, 0) + tally.missed;
  let sofar = 0;
  const x = [0];
  const y = [0];
  for (const [delay, count] of entries) {
    sofar += count;
    x.push(delay);
    y.push(sofar / total);
  }
  return { name, x, y, isStepped: true };
}
