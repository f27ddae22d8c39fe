import uPlot from "uplot";
import type { PanelFrame } from "../../stream/panel-frame";
import { formatNumber } from "../../ui/format";
import { hover } from "../../ui/hover";
import { CANVAS, DASHES, type Scheme } from "../../ui/palette";
import { timeLabels, timeSplits, timeUnit } from "../../ui/time-axis";
import { type UnitScale, unitScale } from "../../ui/unit-scale";
import { type AxisRange, nextRange } from "./axis-range";
import { columnAt } from "./column-at";
import { columnTimes } from "./column-times";
import { type Envelope, envelopePath } from "./envelope-path";
import { listenForGestures, type ScopeGestures } from "./scope-gestures";
import { drawMarks, type Marks } from "./scope-marks";

export interface PlotTrace {
  name: string;
  unit: string;
  colour: string;
  dash: number;
}

export interface ScopePlotOptions {
  host: HTMLElement;
  traces: PlotTrace[];
  scheme: Scheme;
  lineWidth: number;
  fontSize: number;
  marks: () => Marks;
  gestures: ScopeGestures;
}

/** One uPlot with min/max traces on up to two unit axes; fed by frames, never by React. */
export class ScopePlot {
  frame: PanelFrame | undefined;
  /** Ticks shown, kept apart from the frame so that a drag moves the picture before new data come. */
  span = { start: 0, end: 1 };
  /** Tick that the time axis calls zero: 0, or the trigger. */
  origin = 0;
  readonly scales: UnitScale[];
  readonly units: string[];
  private readonly options: ScopePlotOptions;
  private readonly plot: uPlot;
  private ranges: (AxisRange | undefined)[] = [];
  private envelopes: Envelope[] = [];
  private hovered = false;
  private readonly dispose: (() => void)[] = [];

  constructor(options: ScopePlotOptions) {
    this.options = options;
    this.units = [...new Set(options.traces.map((t) => t.unit))].slice(0, 2);
    this.scales = this.units.map((unit) => unitScale(unit, 1));
    this.plot = new uPlot(
      this.uplotOptions(),
      [[0, 1], ...options.traces.map(() => [null, null])] as uPlot.AlignedData,
      options.host,
    );
    this.dispose.push(
      listenForGestures(this.plot.over, options.gestures, () => this.span),
      hover.listen((tick, source) => source !== this && this.showHover(tick)),
    );
    this.plot.over.addEventListener("pointermove", this.pointerMoved);
    this.plot.over.addEventListener("pointerleave", this.pointerLeft);
  }

  destroy(): void {
    if (this.hovered) hover.set(undefined, this);
    for (const stop of this.dispose) stop();
    this.plot.destroy();
  }

  resize(width: number, height: number): void {
    if (width > 20 && height > 20) this.plot.setSize({ width, height });
  }

  /** Width of the data area in pixels of the screen. */
  get pixels(): number {
    return (this.plot.bbox.width / uPlot.pxRatio) * Math.min(window.devicePixelRatio, 2);
  }

  draw(frame: PanelFrame, span?: { start: number; end: number }): void {
    this.frame = frame;
    this.span = span ?? { start: frame.startTick, end: frame.endTick };
    this.origin = frame.triggered ? frame.triggerTick : 0;
    this.fitRanges(frame);
    const { columns, data } = frame;
    this.envelopes = Array.from({ length: frame.signals }, (_, i) => ({
      low: data.subarray(i * 2 * columns, (i * 2 + 1) * columns),
      high: data.subarray((i * 2 + 1) * columns, (i * 2 + 2) * columns),
    }));
    this.plot.setData([columnTimes(frame, this.origin), ...this.envelopes.map((e) => e.high)] as uPlot.AlignedData);
    if (this.hovered) hover.set(this.tickAt(this.plot.cursor.left ?? -1), this);
    else this.showHover(hover.tick);
  }

  /** Show another span of what is there, at once; the data follow. */
  move(start: number, end: number): void {
    this.span = { start, end };
    if (this.frame) this.draw(this.frame, this.span);
  }

  /** Value of a trace at the hovered tick, or the newest one. */
  reading(trace: number): number {
    if (!this.frame || trace >= this.frame.signals) return Number.NaN;
    const { tick } = hover;
    return tick === undefined ? this.frame.latest[trace] : columnAt(this.frame, trace, tick);
  }

  scaleOf(unit: string): UnitScale {
    return this.scales[Math.max(0, this.units.indexOf(unit))];
  }

  private tickAt(left: number): number | undefined {
    const width = this.plot.over.clientWidth;
    if (left < 0 || left > width || !width) return undefined;
    return this.span.start + (left / width) * (this.span.end - this.span.start);
  }

  private showHover(tick: number | undefined): void {
    const share = tick === undefined ? -1 : (tick - this.span.start) / (this.span.end - this.span.start);
    const left = share >= 0 && share <= 1 ? share * this.plot.over.clientWidth : -10;
    this.plot.setCursor({ left, top: left < 0 ? -10 : 1 }, false);
  }

  private readonly pointerMoved = (event: PointerEvent): void => {
    this.hovered = true;
    hover.set(this.tickAt(event.offsetX), this);
  };

  private readonly pointerLeft = (): void => {
    this.hovered = false;
    hover.set(undefined, this);
  };

  private fitRanges(frame: PanelFrame): void {
    const now = performance.now();
    this.units.forEach((unit, axis) => {
      let low = Number.POSITIVE_INFINITY;
      let high = Number.NEGATIVE_INFINITY;
      this.options.traces.forEach((trace, i) => {
        if (trace.unit !== unit || i >= frame.signals) return;
        const end = (i + 1) * 2 * frame.columns;
        for (let c = i * 2 * frame.columns; c < end; c += 1) {
          const v = frame.data[c];
          if (v < low) low = v;
          if (v > high) high = v;
        }
      });
      const range = nextRange(this.ranges[axis], low, high, now);
      if (range !== this.ranges[axis]) {
        this.scales[axis] = unitScale(unit, Math.max(Math.abs(range.min), Math.abs(range.max)));
        this.ranges[axis] = range;
      }
    });
  }

  private uplotOptions(): uPlot.Options {
    const { traces, scheme, lineWidth, fontSize, host } = this.options;
    const colours = CANVAS[scheme];
    const font = `${fontSize}px "IBM Plex Sans Variable", sans-serif`;
    const axis = { font, stroke: colours.muted, ticks: { show: false }, border: { show: false } };
    const spanMs = () => (this.span.end - this.span.start) * (this.frame?.dtMs ?? 1);
    const startMs = () => (this.span.start - this.origin) * (this.frame?.dtMs ?? 1);
    const perLabel = fontSize * 8;
    const two = this.units.length > 1;
    return {
      width: Math.max(50, host.clientWidth),
      height: Math.max(50, host.clientHeight),
      padding: [fontSize + 12, two ? 0 : 12, 0, 0],
      legend: { show: false },
      cursor: {
        y: false,
        drag: { x: false, y: false, setScale: false },
        points: { show: false },
        bind: { dblclick: () => null, mousedown: () => null, mouseup: () => null },
      },
      scales: {
        x: { time: false, range: () => [startMs(), startMs() + spanMs()] },
        ...Object.fromEntries(
          this.units.map((_, i) => [
            `y${i}`,
            { range: (): uPlot.Range.MinMax => [this.ranges[i]?.min ?? -1, this.ranges[i]?.max ?? 1] },
          ]),
        ),
      },
      axes: [
        {
          ...axis,
          scale: "x",
          size: fontSize + 12,
          gap: 4,
          grid: { stroke: colours.grid, width: 1 },
          splits: (u, _i, min, max) => timeSplits(min, max, Math.max(2, u.over.clientWidth / perLabel)),
          values: (_u, splits) => timeLabels(splits, spanMs()),
        },
        ...this.units.map(
          (_, i): uPlot.Axis => ({
            ...axis,
            scale: `y${i}`,
            side: i === 0 ? 3 : 1,
            size: fontSize * 4,
            gap: 6,
            space: fontSize * 1.2,
            grid: { show: i === 0, stroke: colours.grid, width: 1 },
            values: (_u, splits) => axisLabels(splits, this.scales[i]),
          }),
        ),
      ],
      series: [
        {},
        ...traces.map(
          (trace): uPlot.Series => ({
            scale: `y${Math.max(0, this.units.indexOf(trace.unit))}`,
            stroke: trace.colour,
            fill: `${trace.colour}b0`,
            width: lineWidth,
            dash: [...DASHES[trace.dash]],
            points: { show: false },
            paths: envelopePath((series) => this.envelopes[series - 1]),
          }),
        ),
      ],
      hooks: {
        draw: [
          (u) => {
            this.drawUnits(u, font, colours.muted);
            if (this.frame) drawMarks(u, this.options.marks(), this.span, scheme, fontSize);
          },
        ],
      },
    };
  }

  /** Units stand above their axes, the unit of time at the end of its own. */
  private drawUnits(u: uPlot, font: string, colour: string): void {
    const { ctx, bbox } = u;
    const ratio = uPlot.pxRatio;
    ctx.save();
    ctx.font = font.replace(/^([\d.]+)px/, (_m, size: string) => `600 ${Number(size) * ratio}px`);
    ctx.fillStyle = colour;
    ctx.textBaseline = "alphabetic";
    ctx.textAlign = "right";
    ctx.fillText(
      this.scales[0]?.unit ?? "",
      bbox.left - 6 * ratio,
      bbox.top - (this.options.fontSize * 0.5 + 4) * ratio,
    );
    ctx.textAlign = "left";
    if (this.scales[1])
      ctx.fillText(
        this.scales[1].unit,
        bbox.left + bbox.width + 6 * ratio,
        bbox.top - (this.options.fontSize * 0.5 + 4) * ratio,
      );
    ctx.textAlign = "right";
    const spanMs = (this.span.end - this.span.start) * (this.frame?.dtMs ?? 1);
    ctx.fillText(
      timeUnit(spanMs).unit,
      bbox.left - this.options.fontSize * 2.2 * ratio,
      bbox.top + bbox.height + (this.options.fontSize + 5) * ratio,
    );
    ctx.restore();
  }
}

function axisLabels(splits: number[], scale: UnitScale): string[] {
  const step = splits.length > 1 ? Math.abs(splits[1] - splits[0]) * scale.factor : 1;
  const decimals = Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-6)));
  return splits.map((v) => formatNumber(v * scale.factor, decimals));
}
