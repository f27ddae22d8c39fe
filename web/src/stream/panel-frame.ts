/** One panel's picture: min/max columns over a span of ticks, and the newest value of each signal. */
export interface PanelFrame {
  panel: number;
  revision: number;
  signals: number;
  columns: number;
  startTick: number;
  endTick: number;
  /** Tick of the trigger, or NaN. */
  triggerTick: number;
  triggered: boolean;
  waiting: boolean;
  frozen: boolean;
  dtMs: number;
  /** Layout [signal][min, max][column]; NaN where there is no data. */
  data: Float32Array;
  latest: Float32Array;
}

/** One value for each column; with a column for each tick that is the sample. */
export function middles(frame: PanelFrame, signal: number): Float32Array<ArrayBuffer> {
  const found = new Float32Array(frame.columns);
  const low = 2 * signal * frame.columns;
  for (let i = 0; i < frame.columns; i += 1)
    found[i] = 0.5 * (frame.data[low + i] + frame.data[low + frame.columns + i]);
  return found;
}
