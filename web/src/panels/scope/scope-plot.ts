import uPlot from "uplot";
import type { PrintedMark } from "../../api/types";
import { flagWords } from "../../bench/flag-words";
import type { Marks } from "../../bench/marks";
import { markEvents } from "../../picture/event-marks";
import { linesOf } from "../../picture/lines-of";
import type { Field, Look } from "../../picture/pen";
import { reachMarks } from "../../picture/printed-marks";
import { tickRoom } from "../../picture/ticked-range";
import { columnAt, columnTimes, type PanelFrame } from "../../stream/panel-frame";
import { hover } from "../../ui/hover";
import { CANVAS, DASHES, faded, fontFor } from "../../ui/palette";
import { type UnitScale, unitScale } from "../../ui/unit-scale";
import { type AxisRange, nextRange, SHRINK_AFTER_MS } from "./axis-range";
import { BarRaster } from "./bar-raster";
import {
  differenceOf,
  type Envelope,
  magnitudesOf,
  paintEnvelope,
  shadeBetween,
  type TraceField,
} from "./envelope-path";
import { type Banded, bandsOf, samplesOf } from "./envelope-rule";
import { type Ghost, ghostOn } from "./ghost";
import { BEFORE, DIFFERENCE, inkOrder, type PlotTrace, paintScope, type ScopeShown } from "./paint-scope";
import { listenForGestures, type ScopeGestures } from "./scope-gestures";
import { type ScopeModel, scopeOptions } from "./scope-options";
import { drove, whileDriving } from "./while-driving";

const MOST_AXES = 3;
/** Of a logarithmic axis: what is smaller lies at its foot, as every zero does. */
const MOST_DECADES = 8;
/** Samples of a column up to which a trace is a line; bars draw more of them faster, and look the same then. */
const FEW = 2;

export interface ScopePlotOptions extends Look {
  host: HTMLElement;
  traces: PlotTrace[];
  lineWidth: number;
  marks: () => Marks;
  /** What is printed of the figure, if it is to be drawn. */
  printed: () => readonly PrintedMark[];
  /** Magnitudes on a logarithmic scale. */
  isLog: boolean;
  /** Whether the difference from what lies behind is shaded. */
  isShaded: () => boolean;
  /** The samples before the last change, for the traces named `BEFORE`. */
  ghost: () => Ghost | undefined;
  gestures: ScopeGestures;
}

/** The scale of an axis; that of differences is marked. */
function scaleOn(unit: string, size: number): UnitScale {
  if (!unit.startsWith(DIFFERENCE)) return unitScale(unit, size);
  const scale = unitScale(unit.slice(DIFFERENCE.length), size);
  return { ...scale, unit: `${DIFFERENCE}${scale.unit}` };
}

/** A ghost of a trace, unless its controller was in shadow then. */
const hasDriven = (ghost: Ghost | undefined, { drives }: PlotTrace): Ghost | undefined =>
  ghost && (!drives || drove(drives, ghost.frame.endTick - 1)) ? ghost : undefined;

/** One uPlot with min/max traces on up to three unit axes; fed by frames, never by React. */
export class ScopePlot {
  frame: PanelFrame | undefined;
  /** Ticks shown, kept apart from the frame so that a drag moves the picture before new data come. */
  span = { start: 0, end: 1 };
  private readonly options: ScopePlotOptions;
  private readonly units: string[];
  private readonly plot: uPlot;
  private scales: UnitScale[];
  private ranges: (AxisRange | undefined)[] = [];
  private envelopes: Envelope[] = [];
  private times: Float64Array = new Float64Array(0);
  /** Tick of the trigger, which the time axis calls zero. */
  private trigger: number | undefined;
  private hovered = false;
  /** Draws the last frame of a paused board once more, when its axes may shrink. */
  private shrink: ReturnType<typeof setTimeout> | undefined;
  private readonly raster = new BarRaster();
  /** What the raster is laid over the grid with. */
  private readonly bars = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  private readonly dispose: (() => void)[] = [];

  constructor(options: ScopePlotOptions) {
    this.options = options;
    this.units = [...new Set(options.traces.map((t) => t.unit))].slice(0, MOST_AXES);
    this.scales = this.units.map((unit) => scaleOn(unit, 1));
    const empty = [[0, 1], ...options.traces.map(() => [null, null])] as uPlot.AlignedData;
    this.plot = new uPlot(scopeOptions(this.model()), empty, options.host);
    this.dispose.push(
      listenForGestures(this.plot.over, options.gestures, () => this.span),
      hover.listen((tick, source) => source !== this && this.showHover(tick)),
    );
    this.plot.over.addEventListener("pointermove", this.pointerMoved);
    this.plot.over.addEventListener("pointerleave", this.pointerLeft);
  }

  destroy(): void {
    clearTimeout(this.shrink);
    if (this.hovered) hover.set(undefined, this);
    for (const stop of this.dispose) stop();
    this.plot.destroy();
  }

  resize(width: number, height: number): void {
    if (width <= 20 || height <= 20) return;
    this.plot.setSize({ width, height });
    this.ranges = []; // there is room for other ticks
    if (this.frame) this.draw(this.frame, this.span, this.trigger);
  }

  /** Width of the data area in pixels of the screen. */
  get pixels(): number {
    return (this.plot.bbox.width / uPlot.pxRatio) * Math.min(window.devicePixelRatio, 2);
  }

  /** Draw a frame: the span of it that is looked at, about the trigger of a capture or its own. */
  draw(
    frame: PanelFrame,
    span?: { start: number; end: number },
    trigger = frame.triggered ? frame.triggerTick : undefined,
  ): void {
    this.frame = frame;
    this.span = span ?? { start: frame.startTick, end: frame.endTick };
    this.trigger = trigger;
    const { columns, data } = frame;
    this.envelopes = Array.from({ length: frame.signals }, (_, i) => ({
      low: data.subarray(i * 2 * columns, (i * 2 + 1) * columns),
      high: data.subarray((i * 2 + 1) * columns, (i * 2 + 2) * columns),
    }));
    const own = this.own;
    const { traces } = this.options;
    for (let i = 0; i < own; i += 1) {
      const { drives } = traces[i];
      if (drives && this.envelopes[i]) this.envelopes[i] = whileDriving(this.envelopes[i], frame, drives);
    }
    const isSampled = samplesOf(frame) <= 1;
    for (let i = 0; traces[frame.signals + i]?.unit.startsWith(DIFFERENCE) && own + i < frame.signals; i += 1)
      this.envelopes.push(differenceOf(this.envelopes[i], this.envelopes[own + i], isSampled));
    const ghost = this.options.ghost();
    if (traces[this.envelopes.length]?.behind === BEFORE)
      for (let i = 0; i < own; i += 1) this.envelopes.push(ghostOn(hasDriven(ghost, traces[i]), frame, i));
    if (this.options.isLog) this.envelopes = this.envelopes.map(magnitudesOf);
    this.fitRanges();
    clearTimeout(this.shrink);
    if (this.ranges.some((range) => range?.looseSince !== undefined))
      this.shrink = setTimeout(() => this.draw(frame, span, trigger), SHRINK_AFTER_MS);
    const times = columnTimes(frame, this.origin);
    this.times = times;
    this.plot.setData([times, ...this.envelopes.map((e) => e.high)] as uPlot.AlignedData);
    if (this.hovered) hover.set(this.tickAt(this.plot.cursor.left ?? -1), this);
    else this.showHover(hover.tick);
  }

  /** Show another span of what is there, at once; the data follow. */
  move(start: number, end: number): void {
    this.span = { start, end };
    if (this.frame) this.draw(this.frame, this.span, this.trigger);
  }

  /** Value of a trace at the hovered tick if that is in sight, else the newest one. */
  reading(trace: number): number {
    if (!this.frame || trace >= this.frame.signals) return Number.NaN;
    const { tick } = hover;
    const inSight = tick !== undefined && tick >= this.span.start && tick < this.span.end;
    const { drives } = this.options.traces[trace];
    if (drives && !drove(drives, inSight ? tick : this.frame.endTick - 1)) return Number.NaN;
    return inSight ? columnAt(this.frame, trace, tick) : this.frame.latest[trace];
  }

  /** The field of the traces within the host, in pixels of the page. */
  get area(): { left: number; top: number; width: number; height: number } {
    const { left, top, width, height } = this.plot.bbox;
    const ratio = uPlot.pxRatio;
    return { left: left / ratio, top: top / ratio, width: width / ratio, height: height / ratio };
  }

  /** What is shown now; nothing before the first frame has come. */
  picture(): ScopeShown | undefined {
    return this.frame && { ...this.shown(this.frame), bands: this.bands()?.traces ?? [] };
  }

  private shown({ dtMs }: PanelFrame): ScopeShown {
    return {
      traces: this.options.traces,
      envelopes: this.envelopes,
      bands: [],
      times: this.times,
      units: this.units,
      scales: this.scales,
      ranges: this.units.map((_, axis) => this.ranges[axis] ?? { min: -1, max: 1, step: 1 }),
      span: this.span,
      origin: this.origin,
      isTriggered: this.trigger !== undefined,
      isLog: this.options.isLog,
      dtMs,
      marks: this.options.marks(),
      printed: this.options.printed(),
    };
  }

  /** What of the picture is a filled band and no signal. */
  bands(): Banded | undefined {
    if (!this.frame) return undefined;
    const ranges = this.options.traces.map(({ unit }) => this.ranges[this.units.indexOf(unit)]);
    return bandsOf(this.frame, this.envelopes, ranges);
  }

  /** The scale of a unit's axis, or undefined if it has got none. */
  scaleOf(unit: string): UnitScale | undefined {
    return this.scales[this.units.indexOf(unit)];
  }

  /** Tick that the time axis calls zero. */
  private get origin(): number {
    return this.trigger ?? 0;
  }

  private model(): ScopeModel {
    return {
      ...this.options,
      units: this.units,
      time: () => this.shownTime,
      range: (axis) => [this.ranges[axis]?.min ?? -1, this.ranges[axis]?.max ?? 1],
      drawn: (u) => this.drawn(u),
    };
  }

  private get shownTime(): { start: number; span: number } {
    return { start: (this.span.start - this.origin) * this.dtMs, span: (this.span.end - this.span.start) * this.dtMs };
  }

  private get dtMs(): number {
    return this.frame?.dtMs ?? 1;
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

  /** How many traces are of the bench on the page. */
  private get own(): number {
    const at = this.options.traces.findIndex(({ behind }) => behind !== undefined);
    return at < 0 ? this.options.traces.length : at;
  }

  private fitRanges(): void {
    const now = performance.now();
    const room = { ...tickRoom(this.area.height, this.options.fontSize), ...(this.options.isLog && { finest: 1 }) };
    this.units.forEach((unit, axis) => {
      let low = Number.POSITIVE_INFINITY;
      let high = Number.NEGATIVE_INFINITY;
      this.options.traces.forEach((trace, i) => {
        if (trace.unit !== unit || i >= this.envelopes.length) return;
        const envelope = this.envelopes[i];
        for (let c = 0; c < envelope.low.length; c += 1) {
          if (envelope.low[c] < low) low = envelope.low[c];
          if (envelope.high[c] > high) high = envelope.high[c];
        }
      });
      if (this.options.isLog) low = Math.max(low, high - MOST_DECADES);
      else if (low <= high) [low, high] = reachMarks([low, high], this.options.printed(), unit, this.span);
      const range = nextRange(this.ranges[axis], low, high, now, room);
      if (range === this.ranges[axis]) return;
      const size = this.options.isLog ? 10 ** range.max : Math.max(Math.abs(range.min), Math.abs(range.max));
      this.scales[axis] = scaleOn(unit, size);
      this.ranges[axis] = range;
    });
  }

  private drawn({ ctx }: uPlot): void {
    if (!this.frame) return;
    const { left, top, width, height } = this.area;
    const field = { left, right: left + width, top, bottom: top + height };
    const ratio = uPlot.pxRatio;
    const shown = this.shown(this.frame);
    ctx.save();
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    paintScope(ctx, field, shown, this.options, { ink: (traces) => this.inkTraces(ctx, traces) });
    markEvents(ctx, shown, field, this.options, flagWords);
    if (this.envelopes.every((e) => e.high.every(Number.isNaN))) this.drawNothing(ctx, field);
    ctx.restore();
  }

  /** In pixels of the screen, which columns are made for. */
  private inkTraces(ctx: CanvasRenderingContext2D, inked: readonly number[]): void {
    const { traces, lineWidth } = this.options;
    const { left, top, width, height } = this.plot.bbox;
    const { start, span } = this.shownTime;
    const ratio = uPlot.pxRatio;
    const isLine = this.frame !== undefined && samplesOf(this.frame) <= FEW;
    // the raster lies on whole pixels, the field need not
    const [x, y] = [Math.floor(left), Math.floor(top)];
    this.raster.clear(Math.ceil(left + width) - x, Math.ceil(top + height) - y);
    const field = { left: left - x, top: top - y, width, height, from: start, to: start + span };
    ctx.save();
    ctx.setTransform(1, 0, 0, 1, x, y);
    this.shadeDifference(ctx, field, isLine);
    for (const trace of inkOrder(traces, inked)) {
      const { colour, dash, unit } = traces[trace];
      const range = this.ranges[this.units.indexOf(unit)];
      const ink = { colour, width: lineWidth * ratio, dashes: DASHES[dash].map((px) => px * ratio), isLine };
      if (range) paintEnvelope(ctx, this.raster, this.times, this.envelopes[trace], { ...field, ...range }, ink);
    }
    if (this.bars && !this.raster.isEmpty) {
      const { canvas } = this.bars;
      const { image } = this.raster;
      if (canvas.width !== image.width) canvas.width = image.width;
      if (canvas.height !== image.height) canvas.height = image.height;
      this.bars.putImageData(image, 0, 0);
      ctx.drawImage(canvas, 0, 0);
    }
    ctx.restore();
  }

  /** The area between each trace and that of the first bench behind, where columns are samples. */
  private shadeDifference(
    pen: CanvasRenderingContext2D,
    field: Omit<TraceField, "min" | "max">,
    isLine: boolean,
  ): void {
    const { traces, scheme } = this.options;
    const { own } = this;
    if (!traces[own] || traces[own].behind === BEFORE || !isLine || !this.options.isShaded()) return;
    for (let i = 0; i < own; i += 1) {
      const range = this.ranges[this.units.indexOf(traces[i].unit)];
      const [one, other] = [this.envelopes[i], this.envelopes[own + i]];
      if (range && one && other)
        shadeBetween(pen, this.times, one, other, { ...field, ...range }, faded(traces[i].colour, scheme));
    }
  }

  /** A span without data says so: it lies before the history, or ahead of the board. */
  private drawNothing(ctx: CanvasRenderingContext2D, { left, right, top, bottom }: Field): void {
    const { scheme, fontSize } = this.options;
    ctx.font = fontFor(fontSize, 1, 500);
    ctx.fillStyle = CANVAS[scheme].muted;
    ctx.textAlign = "center";
    ctx.textBaseline = "middle";
    const words = this.frame?.waiting
      ? "Waiting for the trigger"
      : "No data here: the bench has dropped it, or has not come to it yet";
    const lines = linesOf(ctx, words, right - left);
    for (const [i, line] of lines.entries())
      ctx.fillText(line, (left + right) / 2, (top + bottom) / 2 + 1.4 * fontSize * (i - (lines.length - 1) / 2));
  }
}
