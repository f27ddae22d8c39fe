import { encodeFrame as encode } from "../stream/encode-frame";

interface PanelFixture {
  panel: number;
  revision: number;
  startTick: number;
  endTick: number;
  /** Tick of the trigger, if there was one. */
  triggerTick?: number;
  flags: number;
  min: number[][];
  max: number[][];
  latest: number[];
}

/** A frame of a bench that runs, from lists of numbers. */
export function encodeFrame(input: {
  frame: number;
  headTick: number;
  dtMs: number;
  panels: PanelFixture[];
}): ArrayBuffer {
  const panels = input.panels.map(({ min, max, latest, flags, triggerTick = Number.NaN, ...rest }) => ({
    ...rest,
    triggerTick,
    signals: min.length,
    columns: min[0].length,
    triggered: (flags & 1) !== 0,
    waiting: (flags & 2) !== 0,
    frozen: (flags & 4) !== 0,
    data: Float32Array.from(min.flatMap((low, i) => [...low, ...max[i]])),
    latest: Float32Array.from(latest),
  }));
  return encode({ ...input, running: true, panels });
}
