import type { BenchmarkRow } from "../api/types";
import type { ChartLine } from "../picture/paint-lines";

/** The title of a diagnoser. */
type Named = (unit: string) => string;

/** A bin with fewer samples says little of how often it is right. */
const LEAST_SAMPLES = 100;
/** The line of a calibrated diagnoser. */
const DIAGONAL: ChartLine = { name: "as often right as said", x: [0, 1], y: [0, 1] };

/** How often diagnosers are right, over their stated probability; a diagnoser without probabilities has no line. */
export function reliabilityLines(rows: readonly BenchmarkRow[], named: Named): ChartLine[] {
  const lines = rows.flatMap((row) => {
    const bins = row.reliability.filter((bin) => bin.samples >= LEAST_SAMPLES);
    return bins.length > 0 ? [{ name: named(row.unit), x: bins.map((b) => b.said), y: bins.map((b) => b.right) }] : [];
  });
  return [DIAGONAL, ...lines];
}

/** The share of faults found over the samples since the fault. */
export function delayLines(rows: readonly BenchmarkRow[], within: readonly number[], named: Named): ChartLine[] {
  return rows.flatMap((row) =>
    row.found_within.length > 0 ? [{ name: named(row.unit), x: [0, ...within], y: [0, ...row.found_within] }] : [],
  );
}
