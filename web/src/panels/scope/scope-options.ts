import uPlot from "uplot";
import { fontFor } from "../../ui/canvas-font";
import { labelsOn } from "../../ui/format";
import { CANVAS, type Scheme } from "../../ui/palette";
import { timeLabels, timeSplits } from "../../ui/time-axis";
import type { UnitScale } from "../../ui/unit-scale";

export interface PlotTrace {
  name: string;
  unit: string;
  /** In `TRACE_COLOURS`; its colour on this screen. */
  slot: number;
  colour: string;
  dash: number;
}

/** What a plot's axes and series ask of the scope while it draws. */
export interface ScopeModel {
  host: HTMLElement;
  traces: PlotTrace[];
  /** Units with an axis, at most three. */
  units: string[];
  scheme: Scheme;
  fontSize: number;
  /** Time shown, in ms from the origin of the time axis. */
  time(): { start: number; span: number };
  range(axis: number): uPlot.Range.MinMax;
  scale(axis: number): UnitScale;
  /** Draw a trace; uPlot keeps its scales alone. */
  trace(u: uPlot, trace: number): void;
  drawn(u: uPlot): void;
}

/** uPlot's options for a scope: device time below, one axis for each unit, min/max traces. */
export function scopeOptions(model: ScopeModel): uPlot.Options {
  const { traces, units, scheme, fontSize, host } = model;
  const colours = CANVAS[scheme];
  const axis = { font: fontFor(fontSize, 1), stroke: colours.muted, ticks: { show: false }, border: { show: false } };
  return {
    width: Math.max(50, host.clientWidth),
    height: Math.max(50, host.clientHeight),
    padding: [fontSize + 7, units.length > 1 ? 0 : fontSize * 1.6, 0, 0],
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
    axes: [
      {
        ...axis,
        scale: "x",
        size: fontSize + 9,
        gap: 4,
        grid: { stroke: colours.grid, width: 1 },
        splits: (u, _i, min, max) => timeSplits(min, max, Math.max(2, u.bbox.width / uPlot.pxRatio / (fontSize * 8))),
        values: (_u, splits) => timeLabels(splits, model.time().span),
      },
      ...units.map(
        (_, i): uPlot.Axis => ({
          ...axis,
          scale: `y${i}`,
          side: i === 0 ? 3 : 1,
          size: fontSize * 4,
          gap: 6,
          space: (_u, _axis, _min, _max, height) => Math.max(fontSize * 1.2, height / 9),
          grid: { show: i === 0, stroke: colours.grid, width: 1 },
          values: (_u, splits) => labelsOn(model.scale(i), splits),
        }),
      ),
    ],
    series: [
      {},
      ...traces.map(
        (trace): uPlot.Series => ({
          show: units.includes(trace.unit),
          scale: `y${Math.max(0, units.indexOf(trace.unit))}`,
          stroke: trace.colour,
          points: { show: false },
          paths: () => null,
        }),
      ),
    ],
    hooks: { drawSeries: [(u, series) => model.trace(u, series - 1)], draw: [(u) => model.drawn(u)] },
  };
}
