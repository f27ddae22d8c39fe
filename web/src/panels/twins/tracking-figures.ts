import type { PanelFrame } from "../../stream/panel-frame";

export interface TrackingFigures {
  rmsError: number;
  peakError: number;
  effort: number;
}

/** Error against the model and effort over a frame with one column for each tick; signals by their columns. */
export function trackingFigures(
  frame: PanelFrame,
  displacement: number,
  model: number,
  voltage: number,
): TrackingFigures {
  const { data, columns } = frame;
  let squares = 0;
  let peak = 0;
  let volts = 0;
  let count = 0;
  for (let c = 0; c < columns; c += 1) {
    const error = data[2 * displacement * columns + c] - data[2 * model * columns + c];
    const volt = data[2 * voltage * columns + c];
    if (Number.isNaN(error) || Number.isNaN(volt)) continue;
    squares += error * error;
    peak = Math.max(peak, Math.abs(error));
    volts += volt * volt;
    count += 1;
  }
  return {
    rmsError: Math.sqrt(squares / count),
    peakError: count ? peak : Number.NaN,
    effort: Math.sqrt(volts / count),
  };
}
