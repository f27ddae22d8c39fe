/** A metric in words: "diagnosis.kalman.correct_fraction" reads "kalman correct fraction". */
export function metricName(metric: string): string {
  return metric
    .replace(/^(?:control|device|diagnosis|identify|lateral|sensing)\./, "")
    .replace(/^twins\.([^.]+)\./, "$1: ")
    .replaceAll(/[._]/g, " ")
    .replaceAll(/\bum\b/g, "µm")
    .replaceAll(/\bpct\b/g, "%");
}

/** What the last part of a field's name says of its unit. */
const UNITS: Record<string, string> = {
  um: "µm",
  nm: "nm",
  pct: "%",
  ms: "ms",
  s: "s",
  hz: "Hz",
  khz: "kHz",
  v: "V",
  pa: "Pa",
  kg: "kg",
  samples: "samples",
};

/** A metric as the title of an axis: "noise_um" reads "noise, µm". */
export function metricTitle(metric: string): string {
  const [, name, unit] = /^(.+)_([a-z]+)$/.exec(metric) ?? [];
  return UNITS[unit] ? `${metricName(name)}, ${UNITS[unit]}` : metricName(metric);
}
