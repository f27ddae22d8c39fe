import type { PanelFrame } from "./panel-frame";
import { WIRE_VERSION } from "./wire";

const FRAME_HEADER = 32;
const PANEL_HEADER = 48;

export interface Frame {
  running: boolean;
  frame: number;
  headTick: number;
  dtMs: number;
  panels: PanelFrame[];
}

/** Read a binary frame without copying: every array is a view into the message. */
export function decodeFrame(buffer: ArrayBuffer): Frame {
  const view = new DataView(buffer);
  if (buffer.byteLength < FRAME_HEADER) throw new RangeError("frame shorter than its header");
  const wire = view.getUint8(0);
  if (wire !== WIRE_VERSION) throw new RangeError(`wire version ${wire}, expected ${WIRE_VERSION}`);
  const dtMs = view.getFloat64(16, true);
  const frame: Frame = {
    running: (view.getUint8(1) & 1) === 1,
    frame: view.getUint32(4, true),
    headTick: view.getFloat64(8, true),
    dtMs,
    panels: [],
  };
  let at = FRAME_HEADER;
  for (let left = view.getUint16(2, true); left > 0; left -= 1) {
    const signals = view.getUint16(at + 2, true);
    const columns = view.getUint32(at + 4, true);
    const flags = view.getUint32(at + 40, true);
    const dataAt = at + PANEL_HEADER;
    const latestAt = dataAt + signals * 2 * columns * 4;
    frame.panels.push({
      panel: view.getUint16(at, true),
      signals,
      columns,
      startTick: view.getFloat64(at + 8, true),
      endTick: view.getFloat64(at + 16, true),
      triggerTick: view.getFloat64(at + 24, true),
      revision: view.getFloat64(at + 32, true),
      triggered: (flags & 1) !== 0,
      waiting: (flags & 2) !== 0,
      frozen: (flags & 4) !== 0,
      dtMs,
      data: new Float32Array(buffer, dataAt, signals * 2 * columns),
      latest: new Float32Array(buffer, latestAt, signals),
    });
    at = latestAt + (signals + (signals % 2)) * 4;
  }
  return frame;
}
