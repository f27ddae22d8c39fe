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
import { extent } from "../phase/phase-range";
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
import { AXIS, BEFORE, DIFFERENCE, inkOrder, type PlotTrace, paintScope, type ScopeShown } from "./paint-scope";
import styles from "./scope.module.css";
import { listenForGestures, type ScopeGestures } from "./scope-gestures";
import { drove, whileDriving } from "./while-driving";

const MOST_AXES = 3;
/** Most decades of a logarithmic axis; smaller values, and every zero, are drawn at its foot. */
const MOST_DECADES = 8;
/** A trace is drawn as a line up to this number of samples per column; above it, bars look the same and are faster. */
const FEW = 2;

interface ScopePlotOptions extends Look {
  host: HTMLElement;
  traces: PlotTrace[];
  lineWidth: number;
  marks: () => Marks;
  /** The printed marks that are drawn now. */
  printed: () => readonly PrintedMark[];
  /** Magnitudes on a logarithmic scale. */
  isLog: boolean;
  /** Whether the difference from the first bench behind is shaded. */
  isShaded: () => boolean;
  /** The samples before the last change, for the traces named `BEFORE`. */
  ghost: () => Ghost | undefined;
  gestures: ScopeGestures;
}

/** The scale of an axis; a scale of differences is marked. */
function scaleOn(unit: string, size: number): UnitScale {
  if (!unit.startsWith(DIFFERENCE)) return unitScale(unit, size);
  const scale = unitScale(unit.slice(DIFFERENCE.length), size);
  return { ...scale, unit: `${DIFFERENCE}${scale.unit}` };
}

/** A ghost of a trace, unless its controller was in shadow then. */
const hasDriven = (ghost: Ghost | undefined, { drives }: PlotTrace): Ghost | undefined =>
  ghost && (!drives || drove(drives, ghost.frame.endTick - 1)) ? ghost : undefined;

/** A canvas with min/max traces on up to three unit axes; fed by frames, never by React. */
export class ScopePlot {
  frame: PanelFrame | undefined;
  /** Ticks shown, kept apart from the frame so that a drag moves the picture before new data come. */
  span = { start: 0, end: 1 };
  private readonly options: ScopePlotOptions;
  private readonly units: string[];
  private readonly canvas = document.createElement("canvas");
  /** Over the field of the traces: it takes the pointer. */
  private readonly over = document.createElement("div");
  private readonly cursor = document.createElement("i");
  /** The field of the traces, in pixels of the canvas. */
  private field = { left: 0, top: 0, width: 1, height: 1 };
  private ratio = 1;
  private scales: UnitScale[];
  private ranges: (AxisRange | undefined)[] = [];
  private envelopes: Envelope[] = [];
  private times: Float64Array = new Float64Array(0);
  /** Tick of the trigger, which the time axis calls zero. */
  private trigger: number | undefined;
  /** Where the pointer is in the field, px. */
  private pointer: number | undefined;
  /** Draws the last frame of a paused board once more, when its axes may shrink. */
  private shrink: ReturnType<typeof setTimeout> | undefined;
  private readonly raster = new BarRaster();
  /** Lays the raster over the grid. */
  private readonly bars = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  private readonly dispose: (() => void)[] = [];

  constructor(options: ScopePlotOptions) {
    this.options = options;
    this.units = [...new Set(options.traces.map((t) => t.unit))].slice(0, MOST_AXES);
    this.scales = this.units.map((unit) => scaleOn(unit, 1));
    this.canvas.className = styles.canvas;
    this.over.className = styles.field;
    this.over.dataset.testid = "field";
    this.cursor.className = styles.hovered;
    this.over.append(this.cursor);
    options.host.append(this.canvas, this.over);
    this.resize(Math.max(50, options.host.clientWidth), Math.max(50, options.host.clientHeight));
    this.dispose.push(
      listenForGestures(this.over, options.gestures, () => this.span),
      hover.listen((tick) => this.showHover(tick)),
    );
    this.over.addEventListener("pointermove", ({ offsetX }) => this.point(offsetX));
    this.over.addEventListener("pointerleave", () => this.point(undefined));
  }

  destroy(): void {
    clearTimeout(this.shrink);
    if (this.pointer !== undefined) this.point(undefined);
    for (const stop of this.dispose) stop();
    this.canvas.remove();
    this.over.remove();
  }

  resize(width: number, height: number): void {
    if (width <= 20 || height <= 20) return;
    const { fontSize } = this.options;
    const right = this.units.length > 1 ? (this.units.length - 1) * AXIS * fontSize : 1.6 * fontSize;
    this.ratio = window.devicePixelRatio;
    const px = (length: number) => Math.round(length * this.ratio);
    this.canvas.width = px(width);
    this.canvas.height = px(height);
    const [left, top] = [px(AXIS * fontSize), px(fontSize + 7)];
    const [fieldWidth, fieldHeight] = [px(width - right) - left, px(height - fontSize - 9) - top];
    this.field = { left, top, width: Math.max(1, fieldWidth), height: Math.max(1, fieldHeight) };
    for (const [side, length] of Object.entries(this.area)) this.over.style.setProperty(side, `${length}px`);
    this.ranges = []; // there is room for other ticks
    if (this.frame) this.draw(this.frame, this.span, this.trigger);
  }

  /** Width of the data area in pixels of the screen. */
  get pixels(): number {
    return this.area.width * Math.min(window.devicePixelRatio, 2);
  }

  /** Draw a span of a frame, about the trigger of a capture or its own. */
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
    this.times = columnTimes(frame, this.origin);
    if (this.pointer !== undefined) this.point(this.pointer);
    this.showHover(hover.tick);
    this.paint(frame);
  }

  /** Show another span of the data of now, at once; its own data follow. */
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
    const { ratio } = this;
    const { left, top, width, height } = this.field;
    return { left: left / ratio, top: top / ratio, width: width / ratio, height: height / ratio };
  }

  /** The picture shown now; undefined before the first frame has come. */
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

  /** The traces that the picture shows as filled bands. */
  bands(): Banded | undefined {
    if (!this.frame) return undefined;
    const ranges = this.options.traces.map(({ unit }) => this.ranges[this.units.indexOf(unit)]);
    return bandsOf(this.frame, this.envelopes, ranges);
  }

  /** The scale of the axis of a unit; undefined for a unit without an axis. */
  scaleOf(unit: string): UnitScale | undefined {
    return this.scales[this.units.indexOf(unit)];
  }

  /** Tick that the time axis calls zero. */
  private get origin(): number {
    return this.trigger ?? 0;
  }

  /** Tell every panel the tick under the pointer. */
  private point(offset: number | undefined): void {
    this.pointer = offset;
    const { start, end } = this.span;
    hover.set(offset === undefined ? undefined : start + (offset / this.area.width) * (end - start));
  }

  private showHover(tick: number | undefined): void {
    const share = tick === undefined ? -1 : (tick - this.span.start) / (this.span.end - this.span.start);
    this.cursor.hidden = share < 0 || share > 1;
    this.cursor.style.left = `${100 * share}%`;
  }

  /** How many traces are of the bench on the page. */
  private get own(): number {
    const at = this.options.traces.findIndex(({ behind }) => behind !== undefined);
    return at < 0 ? this.options.traces.length : at;
  }

  private fitRanges(): void {
    const now = performance.now();
    const room = { ...tickRoom(this.area.height, this.options.fontSize), ...(this.options.isLog && { finest: 1 }) };
    this.units.forEach((unit, axis) => {
      const own = this.envelopes.filter((_, i) => this.options.traces[i]?.unit === unit);
      const ends = own.flatMap((one) => [...(extent(one.low) ?? []), ...(extent(one.high) ?? [])]);
      let [low, high] = [Math.min(...ends), Math.max(...ends)];
      if (this.options.isLog) low = Math.max(low, high - MOST_DECADES);
      else if (low <= high) [low, high] = reachMarks([low, high], this.options.printed(), unit, this.span);
      const range = nextRange(this.ranges[axis], low, high, now, room);
      if (range === this.ranges[axis]) return;
      const size = this.options.isLog ? 10 ** range.max : Math.max(Math.abs(range.min), Math.abs(range.max));
      this.scales[axis] = scaleOn(unit, size);
      this.ranges[axis] = range;
    });
  }

  private paint(frame: PanelFrame): void {
    const ctx = this.canvas.getContext("2d");
    if (!ctx) return;
    const { left, top, width, height } = this.area;
    const field = { left, right: left + width, top, bottom: top + height };
    const shown = this.shown(frame);
    ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    ctx.clearRect(0, 0, this.canvas.width, this.canvas.height);
    paintScope(ctx, field, shown, this.options, { ink: (traces) => this.inkTraces(ctx, frame, traces) });
    markEvents(ctx, shown, field, this.options, flagWords);
    if (this.envelopes.every((e) => e.high.every(Number.isNaN))) this.drawNothing(ctx, frame, field);
  }

  /** In pixels of the screen, which columns are made for. */
  private inkTraces(ctx: CanvasRenderingContext2D, frame: PanelFrame, inked: readonly number[]): void {
    const { traces, lineWidth } = this.options;
    const { ratio } = this;
    const { left, top, width, height } = this.field;
    const from = (this.span.start - this.origin) * frame.dtMs;
    const to = (this.span.end - this.origin) * frame.dtMs;
    const isLine = samplesOf(frame) <= FEW;
    this.raster.clear(width, height);
    const field = { left: 0, top: 0, width, height, from, to };
    ctx.save();
    ctx.setTransform(1, 0, 0, 1, left, top);
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

  /** The area between each trace and the trace of the first bench behind, where columns are samples. */
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

  /** Say that a span has no data: it is before the history, or ahead of the board. */
  private drawNothing(ctx: CanvasRenderingContext2D, frame: PanelFrame, { left, right, top, bottom }: Field): void {
    const { scheme, fontSize } = this.options;
    ctx.font = fontFor(fontSize, 1, 500);
    ctx.fillStyle = CANVAS[scheme].muted;
    ctx.textAlign = "center";
    ctx.textBaseline = "middle";
    const words = frame.waiting
      ? "Waiting for the trigger"
      : "No data here: the bench has dropped it, or has not come to it yet";
    const lines = linesOf(ctx, words, right - left);
    for (const [i, line] of lines.entries())
      ctx.fillText(line, (left + right) / 2, (top + bottom) / 2 + 1.4 * fontSize * (i - (lines.length - 1) / 2));
  }
}
