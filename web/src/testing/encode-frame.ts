import { WIRE_VERSION } from "../stream/wire";

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

/** Write a frame as the server does; for tests only. */
export function encodeFrame(input: {
  frame: number;
  headTick: number;
  dtMs: number;
  panels: PanelFixture[];
}): ArrayBuffer {
  const size = input.panels.reduce(
    (sum, p) => sum + 48 + p.min.length * (p.min[0].length * 8 + 4) + (p.min.length % 2) * 4,
    32,
  );
  const view = new DataView(new ArrayBuffer(size));
  view.setUint8(0, WIRE_VERSION);
  view.setUint8(1, 1);
  view.setUint16(2, input.panels.length, true);
  view.setUint32(4, input.frame, true);
  view.setFloat64(8, input.headTick, true);
  view.setFloat64(16, input.dtMs, true);
  let at = 32;
  const float = (value: number) => {
    view.setFloat32(at, value, true);
    at += 4;
  };
  for (const p of input.panels) {
    view.setUint16(at, p.panel, true);
    view.setUint16(at + 2, p.min.length, true);
    view.setUint32(at + 4, p.min[0].length, true);
    view.setFloat64(at + 8, p.startTick, true);
    view.setFloat64(at + 16, p.endTick, true);
    view.setFloat64(at + 24, p.triggerTick ?? Number.NaN, true);
    view.setFloat64(at + 32, p.revision, true);
    view.setUint32(at + 40, p.flags, true);
    at += 48;
    p.min.forEach((low, i) => {
      low.forEach(float);
      p.max[i].forEach(float);
    });
    p.latest.forEach(float);
    if (p.latest.length % 2) float(0);
  }
  return view.buffer as ArrayBuffer;
}
