import type { DiagnosisTally, PointTally } from "../api/types";
import type { ChartLine } from "../picture/paint-lines";
import { formatShort } from "../ui/format";
import { type MetricScale, metricScale } from "../ui/metric-name";

/** Figures shown before anybody chooses. */
const USUAL = [/\.correct_fraction$/, /\.mean_delay_samples$/, /\.false_switches$/, /^control\.rms_error_um$/];

/** How the values of an axis are shown, by the end of its path. */
export const labelScale = (path: string, values: readonly (string | number | undefined)[]): MetricScale =>
  metricScale(
    path.split(".").at(-1) ?? path,
    values.filter((value) => typeof value === "number"),
  );

/** A value a point differs by; a number cut to what can be told apart. */
export const labelText = (value: string | number, shown = (number: number) => number) =>
  typeof value === "number" ? formatShort(shown(value), "") : value;

/** What a point is called: the values it differs by. */
export function pointName(labels: PointTally["labels"]): string {
  const parts = Object.entries(labels).map(([path, value]) => {
    if (path === "variant") return labelText(value);
    const { name, unit, shown } = labelScale(path, [value]);
    return `${name} ${labelText(value, shown)}${unit ? `\u00a0${unit}` : ""}`;
  });
  return parts.join(", ") || "all runs";
}

/** All figures that were measured, in the order they come. */
export function metricsOf(points: readonly PointTally[]): string[] {
  return [...new Set(points.flatMap((point) => Object.keys(point.metrics ?? {})))].sort();
}

/** The figures to begin with: the usual ones, else the first few. */
export function usualMetrics(points: readonly PointTally[]): string[] {
  const all = metricsOf(points);
  const usual = all.filter((name) => USUAL.some((pattern) => pattern.test(name)));
  return (usual.length ? usual : all).slice(0, 4);
}

/** The axes that are numbers and were varied. */
export function numericAxes(points: readonly PointTally[]): string[] {
  const axes = [...new Set(points.flatMap((point) => Object.keys(point.labels)))];
  return axes.filter((axis) => {
    const values = points.map((point) => point.labels[axis]);
    return values.every((v) => typeof v === "number") && new Set(values).size > 1;
  });
}

/** A figure over a varied number, one line for each combination of the rest. */
export function trend(points: readonly PointTally[], axis: string, metric: string): ChartLine[] {
  const groups = new Map<string, PointTally[]>();
  const named = (point: PointTally) =>
    pointName(Object.fromEntries(Object.entries(point.labels).filter(([name]) => name !== axis)));
  const isScattered = new Set(points.map(named)).size === points.length && points.length > 8;
  for (const point of points) {
    if (!point.metrics?.[metric]) continue;
    const name = isScattered ? "" : named(point);
    groups.set(name, [...(groups.get(name) ?? []), point]);
  }
  return [...groups].map(([name, group]) => {
    const found = group
      .flatMap((point) => {
        const figure = point.metrics?.[metric];
        return figure ? [{ x: Number(point.labels[axis]), figure }] : [];
      })
      .sort((a, b) => a.x - b.x);
    return {
      name: name === "all runs" ? "" : name,
      x: found.map((entry) => entry.x),
      y: found.map((entry) => entry.figure.mean),
      spread: found.map((entry) => entry.figure.std),
    };
  });
}

/** The share of changes found within so many samples; what was never found keeps it below one. */
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
