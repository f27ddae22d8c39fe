import type uPlot from "uplot";
import { AXIS, type PlotTrace } from "./paint-scope";

/** What a plot asks of the scope while it draws. */
export interface ScopeModel {
  host: HTMLElement;
  traces: PlotTrace[];
  /** Units with an axis, at most three. */
  units: string[];
  fontSize: number;
  /** Time shown, in ms from the origin of the time axis. */
  time(): { start: number; span: number };
  range(axis: number): uPlot.Range.MinMax;
  drawn(u: uPlot): void;
}

/** uPlot's options for a scope: it keeps the canvas, the scales and the cursor, and inks nothing itself. */
export function scopeOptions({ host, traces, units, fontSize, ...model }: ScopeModel): uPlot.Options {
  const right = units.length > 1 ? (units.length - 1) * AXIS * fontSize : fontSize * 1.6;
  return {
    width: Math.max(50, host.clientWidth),
    height: Math.max(50, host.clientHeight),
    padding: [fontSize + 7, right, fontSize + 9, AXIS * fontSize],
    legend: { show: false },
    cursor: {
      y: false,
      drag: { x: false, y: false, setScale: false },
      points: { show: false },
      bind: { dblclick: () => null, mousedown: () => null, mouseup: () => null },
    },
    scales: {
      x: {
        time: false,
        range: () => {
          const { start, span } = model.time();
          return [start, start + span];
        },
      },
      ...Object.fromEntries(units.map((_, i) => [`y${i}`, { range: () => model.range(i) }])),
    },
    axes: [{ show: false }],
    series: [
      {},
      ...traces.map(
        (trace): uPlot.Series => ({
          show: units.includes(trace.unit),
          scale: `y${Math.max(0, units.indexOf(trace.unit))}`,
          points: { show: false },
          paths: () => null,
        }),
      ),
    ],
    hooks: { draw: [(u) => model.drawn(u)] },
  };
}
