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
