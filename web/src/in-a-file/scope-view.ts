import type { ActiveFault, LogEntry } from "../api/types";
import { faultSpans, type Marks } from "../bench/marks";
import type { PlotTrace } from "../panels/scope/paint-scope";
import { ScopePlot } from "../panels/scope/scope-plot";
import { presetsOn } from "../panels/scope/scope-presets";
import { formatSi } from "../ui/format";
import { DASHES, type Scheme } from "../ui/palette";
import { traceColour, traceStyle } from "../ui/trace-style";
import { element, menu, write } from "./dom";
import type { FileBench } from "./file-bench";
import { frameOf } from "./frame-of";
import type { TimeWindow } from "./time-window";

export const FONT_PX = 12;
const LINE_PX = 1.6;
/** More signals cannot be distinguished. */
const MOST = 12;

/** A scope of the page over the signals of a preset. */
export class ScopeView {
  readonly root = element("section", { className: "panel scope" });
  private readonly bench: FileBench;
  private readonly time: TimeWindow;
  private readonly host = element("div", { className: "plot" });
  private readonly legend = element("div", { className: "legend" });
  private traces: PlotTrace[] = [];
  private signals: number[] = [];
  private readings: HTMLElement[] = [];
  private plot: ScopePlot | undefined;
  private scheme: Scheme = "dark";
  private known: { log: unknown; marks: Marks } | undefined;

  constructor(bench: FileBench, time: TimeWindow, title: string) {
    this.bench = bench;
    this.time = time;
    const presets = presetsOn(bench.signals);
    const chosen = presets.find((one) => one.title === title) ?? presets[0];
    const choose = (title: string) => this.choose(presets.find((one) => one.title === title)?.signals ?? []);
    const choices = presets.map(({ title }) => [title, title] as const);
    const top = element("div", { className: "line" }, menu("Signals", choices, chosen.title, choose), this.legend);
    this.root.append(top, this.host);
    this.root.ariaLabel = `Scope: ${chosen.title}`;
    this.choose(chosen.signals);
    new ResizeObserver(([{ contentRect }]) => this.plot?.resize(contentRect.width, contentRect.height)).observe(
      this.host,
    );
  }

  /** Show it in these colours. */
  dress(scheme: Scheme): void {
    this.scheme = scheme;
    this.choose(this.signals.map((signal) => this.bench.signals[signal].name));
  }

  /** Draw the ticks that the panels show. */
  draw(tells: boolean): void {
    const { plot, time, bench, signals } = this;
    if (!plot || this.host.clientWidth === 0) return;
    plot.draw(frameOf(bench, signals, time.span, plot.pixels, time.isHeld), time.span);
    if (!tells) return;
    this.traces.forEach(({ unit }, i) => {
      write(this.readings[i], formatSi(plot.reading(i), unit, 3));
    });
  }

  private choose(names: readonly string[]): void {
    const { signals, diagnosers } = this.bench;
    const all = signals.map(({ name }) => name);
    const hypotheses = Object.values(diagnosers)[0]?.names ?? [];
    this.signals = names.slice(0, MOST).map((name) => all.indexOf(name));
    this.traces = this.signals.map((signal) => {
      const { name, unit } = signals[signal];
      const style = traceStyle(name, all, hypotheses);
      return { name, unit, ...style, colour: traceColour(style, this.scheme) };
    });
    const marks = (this.bench.document.published?.marks ?? []).filter(({ signal }) => names.includes(signal));
    this.plot?.destroy();
    this.plot = new ScopePlot({
      host: this.host,
      traces: this.traces,
      scheme: this.scheme,
      lineWidth: LINE_PX,
      fontSize: FONT_PX,
      marks: () => this.marks(),
      printed: () => marks,
      isLog: false,
      isShaded: () => false,
      ghost: () => undefined,
      gestures: { onSpan: this.time.look, onLive: this.time.goLive },
    });
    this.writeLegend();
    this.draw(true);
  }

  private writeLegend(): void {
    this.readings = this.traces.map(() => element("b"));
    const swatch = ({ colour, dash }: PlotTrace) =>
      `<svg width="18" height="4" aria-hidden="true"><line x2="18" y1="2" y2="2" stroke="${colour}" stroke-width="2.5" stroke-dasharray="${DASHES[dash].join(" ")}"/></svg>`;
    this.legend.replaceChildren(
      ...this.traces.map((trace, i) => {
        const line = element("span", { className: "trace", innerHTML: swatch(trace) });
        line.append(trace.name, " ", this.readings[i]);
        return line;
      }),
    );
  }

  /** Worked out once for each change of the log. */
  private marks(): Marks {
    const { log, tick } = this.bench;
    if (this.known?.log !== log) {
      const events = log as unknown as LogEntry[];
      const acting = [...this.bench.faults].map(([name, { severity, since }]) => ({
        name,
        severity,
        since_tick: since,
      }));
      const faults = faultSpans(events, acting as unknown as ActiveFault[], tick);
      this.known = { log, marks: { events, faults } };
    }
    return this.known.marks;
  }
}
