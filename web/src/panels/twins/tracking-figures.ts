import type { PanelFrame } from "../../stream/panel-frame";

export interface TrackingFigures {
  rmsError: number;
  peakError: number;
  /** rms of each effort. */
  efforts: number[];
}

/** Error from the ideal value, and efforts, over a frame with one column for each tick; signals by their columns. */
export function trackingFigures(frame: PanelFrame, value: number, ideal: number, efforts: number[]): TrackingFigures {
  const { data, columns } = frame;
  const at = (signal: number, c: number) => data[2 * signal * columns + c];
  let squares = 0;
  let peak = 0;
  let count = 0;
  const spent = efforts.map(() => 0);
  for (let c = 0; c < columns; c += 1) {
    const error = at(value, c) - at(ideal, c);
    if (Number.isNaN(error) || efforts.some((effort) => Number.isNaN(at(effort, c)))) continue;
    squares += error * error;
    peak = Math.max(peak, Math.abs(error));
    efforts.forEach((effort, i) => {
      spent[i] += at(effort, c) ** 2;
    });
    count += 1;
  }
  return {
    rmsError: Math.sqrt(squares / count),
    peakError: count ? peak : Number.NaN,
    efforts: spent.map((sum) => Math.sqrt(sum / count)),
  };
}
