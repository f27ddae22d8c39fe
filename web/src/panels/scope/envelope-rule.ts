import type { PanelFrame } from "../../stream/panel-frame";
import type { AxisRange } from "./axis-range";
import type { Envelope } from "./envelope-path";

/** Least thickness of a band, as a share of the axis; a thinner trace looks like a line. */
const THIN = 0.03;
/** Least share of the columns that makes a trace a band. */
const MOST = 0.5;

/**
 * Whether a trace is drawn as a filled band and not as a signal.
 *
 * The columns of a resolved signal meet: each begins where the column before ended. A signal that turns several times
 * within a column fills the same heights again in the next.
 */
export function isEnvelope({ low, high }: Envelope, height: number): boolean {
  let filled = 0;
  let drawn = 0;
  for (let c = 0; c + 1 < low.length; c += 1) {
    if (Number.isNaN(low[c]) || Number.isNaN(low[c + 1])) continue;
    drawn += 1;
    const least = Math.min(high[c] - low[c], high[c + 1] - low[c + 1]);
    const shared = Math.min(high[c], high[c + 1]) - Math.max(low[c], low[c + 1]);
    if (least > THIN * height && shared > 0.5 * least) filled += 1;
  }
  return drawn > 0 && filled > MOST * drawn;
}

/** The traces that a scope draws as bands, and the time that each of their pixels takes. */
export interface Banded {
  traces: number[];
  perPixelMs: number;
  samples: number;
}

/** How many samples a column holds. */
export const samplesOf = ({ startTick, endTick, columns }: Pick<PanelFrame, "startTick" | "endTick" | "columns">) =>
  (endTick - startTick) / columns;

/** The bands of a picture; none where every column is a sample. */
export function bandsOf(
  frame: PanelFrame,
  envelopes: Envelope[],
  ranges: (Pick<AxisRange, "min" | "max"> | undefined)[],
): Banded | undefined {
  const samples = samplesOf(frame);
  if (samples <= 1) return undefined;
  const traces = envelopes.flatMap((envelope, i) => {
    const range = ranges[i];
    return range && isEnvelope(envelope, range.max - range.min) ? [i] : [];
  });
  return traces.length > 0 ? { traces, perPixelMs: samples * frame.dtMs, samples } : undefined;
}
