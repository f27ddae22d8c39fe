/** A metric in words: "diagnosis.kalman.correct_fraction" reads "kalman correct fraction". */
export function metricName(metric: string): string {
  return metric
    .replace(/^(?:control|device|diagnosis|identify|lateral|sensing)\./, "")
    .replace(/^twins\.([^.]+)\./, "$1: ")
    .replaceAll(/[._]/g, " ")
    .replaceAll(/\bum\b/g, "µm")
    .replaceAll(/\bpct\b/g, "%");
}
