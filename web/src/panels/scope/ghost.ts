import { largest, lowest, type PanelFrame } from "../../stream/panel-frame";
import type { Envelope } from "./envelope-path";

/** The last samples before a change, to be drawn again under the samples after it. */
export interface Ghost {
  /** It ends at the change. */
  frame: PanelFrame;
  /** Where the trace after the change begins. */
  since: number;
  /** Of the drive, in ticks. */
  period: number | null | undefined;
}

/** The ghost is drawn this much later than it was: whole periods, so that it is in phase with the live trace. */
function shiftOf(period: Ghost["period"], elapsed: number): number {
  return period ? Math.ceil(elapsed / period) * period : elapsed;
}

/** A signal of the ghost in the columns of a live frame; no data before the change, nor while the ghost is on its way. */
export function ghostOn(ghost: Ghost | undefined, live: PanelFrame, signal: number): Envelope {
  const [low, high] = [
    new Float32Array(live.columns).fill(Number.NaN),
    new Float32Array(live.columns).fill(Number.NaN),
  ];
  if (!ghost || signal >= ghost.frame.signals) return { low, high };
  const { frame } = ghost;
  const [least, most] = [lowest(frame, signal), largest(frame, signal)];
  const per = (live.endTick - live.startTick) / live.columns;
  const held = (frame.endTick - frame.startTick) / frame.columns;
  const shift = shiftOf(ghost.period, live.endTick - frame.endTick);
  for (let c = 0; c < live.columns; c += 1) {
    const tick = live.startTick + c * per;
    if (tick < ghost.since) continue;
    const at = (tick - shift - frame.startTick) / held;
    const first = Math.floor(at);
    if (first < 0) continue;
    if (per === 1 && held === 1) low[c] = high[c] = between(least, at);
    else {
      const end = Math.min(frame.columns, Math.max(first + 1, Math.floor(at + per / held)));
      for (let k = first; k < end; k += 1) {
        if (!(least[k] >= low[c])) low[c] = least[k];
        if (!(most[k] <= high[c])) high[c] = most[k];
      }
    }
  }
  return { low, high };
}

/** The value between two samples. */
function between(samples: Float32Array, at: number): number {
  const first = Math.floor(at);
  const part = at - first;
  return part === 0 ? samples[first] : (1 - part) * samples[first] + part * samples[first + 1];
}
