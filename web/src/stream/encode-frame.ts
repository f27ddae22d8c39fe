import type { PanelFrame } from "./panel-frame";
import { WIRE_VERSION } from "./wire";

const HEADER = 32;
const PANEL_HEADER = 48;

type Picture = Omit<PanelFrame, "dtMs">;

export interface FrameParts {
  frame: number;
  running: boolean;
  headTick: number;
  dtMs: number;
  panels: readonly Picture[];
}

/** Write a frame as the server does; `decodeFrame` reads it. */
export function encodeFrame({ frame, running, headTick, dtMs, panels }: FrameParts): ArrayBuffer {
  const size = panels.reduce((sum, one) => sum + PANEL_HEADER + 4 * numbersOf(one), HEADER);
  const buffer = new ArrayBuffer(size);
  const view = new DataView(buffer);
  view.setUint8(0, WIRE_VERSION);
  view.setUint8(1, Number(running));
  view.setUint16(2, panels.length, true);
  view.setUint32(4, frame, true);
  view.setFloat64(8, headTick, true);
  view.setFloat64(16, dtMs, true);
  let at = HEADER;
  for (const one of panels) {
    view.setUint16(at, one.panel, true);
    view.setUint16(at + 2, one.signals, true);
    view.setUint32(at + 4, one.columns, true);
    view.setFloat64(at + 8, one.startTick, true);
    view.setFloat64(at + 16, one.endTick, true);
    view.setFloat64(at + 24, one.triggerTick, true);
    view.setFloat64(at + 32, one.revision, true);
    view.setUint32(at + 40, Number(one.triggered) + 2 * Number(one.waiting) + 4 * Number(one.frozen), true);
    const numbers = new Float32Array(buffer, at + PANEL_HEADER, numbersOf(one));
    numbers.set(one.data);
    numbers.set(one.latest, one.data.length);
    at += PANEL_HEADER + numbers.byteLength;
  }
  return buffer;
}

/** Minima and maxima of all columns, then the latest values, as an even number of numbers. */
const numbersOf = ({ signals, columns }: Picture): number => 2 * signals * columns + signals + (signals % 2);
