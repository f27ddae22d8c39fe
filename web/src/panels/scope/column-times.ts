import type { PanelFrame } from "../../stream/panel-frame";

/** Where each column lies, in ms, relative to `originTick`: the middle of the ticks it covers. */
export function columnTimes(frame: PanelFrame, originTick: number): Float64Array {
  const per = (frame.endTick - frame.startTick) / frame.columns;
  const middle = Math.max(0, (per - 1) / 2);
  const times = new Float64Array(frame.columns);
  for (let c = 0; c < times.length; c += 1) times[c] = (frame.startTick - originTick + c * per + middle) * frame.dtMs;
  return times;
}
