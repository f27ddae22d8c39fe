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

/** Smallest value of a signal in each column. */
export const lowest = ({ data, columns }: PanelFrame, signal: number): Float32Array =>
  data.subarray(2 * signal * columns, (2 * signal + 1) * columns);

/** Largest value of a signal in each column. */
export const largest = ({ data, columns }: PanelFrame, signal: number): Float32Array =>
  data.subarray((2 * signal + 1) * columns, (2 * signal + 2) * columns);

/** Tick at which a column begins. */
export const tickOf = ({ startTick, endTick, columns }: PanelFrame, column: number): number =>
  startTick + (column * (endTick - startTick)) / columns;

/** Value of a signal at a tick: the middle of its column, or the nearest column to the left that has data. */
export function columnAt(frame: PanelFrame, signal: number, tick: number): number {
  const { columns, startTick, endTick, data } = frame;
  const at = Math.floor(((tick - startTick) * columns) / (endTick - startTick));
  const base = signal * 2 * columns;
  for (let c = Math.min(at, columns - 1); c >= 0 && c > at - 40; c -= 1) {
    const low = data[base + c];
    if (!Number.isNaN(low)) return (low + data[base + columns + c]) / 2;
  }
  return Number.NaN;
}

/** The place of each column, in ms, relative to `originTick`: the middle of the ticks it covers. */
export function columnTimes(frame: PanelFrame, originTick: number): Float64Array {
  const per = (frame.endTick - frame.startTick) / frame.columns;
  const middle = Math.max(0, (per - 1) / 2);
  const times = new Float64Array(frame.columns);
  for (let c = 0; c < times.length; c += 1) times[c] = (frame.startTick - originTick + c * per + middle) * frame.dtMs;
  return times;
}
