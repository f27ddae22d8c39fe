import type { PanelFrame } from "../stream/panel-frame";
import type { FileBench } from "./file-bench";

/** The picture of signals over a span of ticks, as a panel of the page takes it. */
export function frameOf(
  bench: FileBench,
  signals: readonly number[],
  span: { start: number; end: number },
  columns: number,
  isFrozen: boolean,
): PanelFrame {
  const [start, end] = [Math.floor(span.start), Math.ceil(span.end)];
  const count = Math.max(1, Math.min(Math.round(columns), end - start));
  return {
    panel: 0,
    revision: 0,
    signals: signals.length,
    columns: count,
    startTick: start,
    endTick: end,
    triggerTick: Number.NaN,
    triggered: false,
    waiting: false,
    frozen: isFrozen,
    dtMs: bench.document.dt_ms,
    data: bench.cut(signals, start, end, count),
    latest: Float32Array.from(signals, (signal) => bench.latest(signal)),
  };
}
