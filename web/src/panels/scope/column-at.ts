import type { PanelFrame } from "../../stream/panel-frame";

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
