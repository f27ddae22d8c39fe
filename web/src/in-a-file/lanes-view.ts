import type { LogEntry } from "../api/types";
import { hypothesisWords } from "../bench/hypothesis-words";
import { truthSwitches } from "../panels/lanes/delays";
import { lanesLayout, leastHeight } from "../panels/lanes/lanes-layout";
import { paintLanes } from "../panels/lanes/paint-lanes";
import { listenForGestures } from "../panels/scope/scope-gestures";
import { hover } from "../ui/hover";
import { fontFor, type Scheme } from "../ui/palette";
import { element, menu } from "./dom";
import type { FileBench } from "./file-bench";
import { frameOf } from "./frame-of";
import { FONT_PX } from "./scope-view";
import type { TimeWindow } from "./time-window";

const WORDS_SHARE = 0.42;

/** The lanes of a diagnoser that the reader chooses, by the painter of the page. */
export class LanesView {
  readonly root = element("section", { className: "panel lanes" });
  private readonly bench: FileBench;
  private readonly time: TimeWindow;
  private readonly canvas = element("canvas");
  private readonly over = element("div", { className: "over" });
  private id: string;

  constructor(bench: FileBench, time: TimeWindow, ids: readonly string[]) {
    this.bench = bench;
    this.time = time;
    this.id = ids[0];
    const choose = (id: string) => {
      this.id = id;
      time.tell();
    };
    const choices = ids.map((id) => [id, bench.diagnosers[id].title] as const);
    const head = ids.length > 1 ? menu("Diagnoser", choices, this.id, choose) : element("b", {}, choices[0][1]);
    const plot = element("div", { className: "plot" }, this.canvas, this.over);
    const least = Math.max(...ids.map((id) => leastHeight(bench.diagnosers[id].names.length, FONT_PX)));
    plot.style.minHeight = `${least}px`;
    this.root.append(element("div", { className: "line" }, head), plot);
    this.canvas.role = "img";
    this.canvas.ariaLabel = "Probability of each hypothesis over time";
    listenForGestures(this.over, { onSpan: time.look, onLive: time.goLive }, () => time.span);
    const point = (offset: number | undefined) => {
      const { start, end } = time.span;
      hover.set(offset === undefined ? undefined : start + (offset / this.over.clientWidth) * (end - start));
    };
    this.over.addEventListener("pointermove", ({ offsetX }) => point(offsetX));
    this.over.addEventListener("pointerleave", () => point(undefined));
  }

  /** Draw the ticks that the panels show. */
  draw(scheme: Scheme): void {
    const { canvas, id } = this;
    const bench = this.bench;
    const time = this.time;
    const { clientWidth: width, clientHeight: height } = canvas;
    const pen = canvas.getContext("2d");
    if (!pen || width < 80) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const { names } = bench.diagnosers[id];
    const words = names.map((name) => hypothesisWords(name));
    pen.font = fontFor(FONT_PX, ratio, 700);
    const widthOf = (texts: string[]) => Math.max(...texts.map((text) => pen.measureText(text).width)) / ratio + 22;
    const labels = widthOf(words) <= width * WORDS_SHARE ? words : names;
    const left = Math.max(FONT_PX * 6, widthOf(labels));
    const layout = lanesLayout(width, height, names.length, FONT_PX, left);
    this.over.style.left = `${left}px`;
    this.over.style.right = `${width - layout.right}px`;
    const all = bench.signals.map(({ name }) => name);
    const ports = [...names.map((name) => `probability.${name}`), "winner", "truth", "unexplained"];
    const signals = ports.map((port) => all.indexOf(`${id}.${port}`)).filter((signal) => signal >= 0);
    const { span, isHeld } = time;
    const frame = frameOf(bench, signals, span, (layout.right - left) * ratio, isHeld);
    const inSight = hover.tick !== undefined && hover.tick >= span.start && hover.tick < span.end;
    const switches = truthSwitches(bench.log as unknown as LogEntry[], id);
    const withUnexplained = all.includes(`${id}.unexplained`);
    const shown = { frame, span, hover: inSight ? hover.tick : undefined, switches, names, labels };
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    paintLanes(
      pen,
      { width, height },
      { ...shown, gutter: left / FONT_PX, withTruth: true, withUnexplained, picked: undefined },
      { scheme, fontSize: FONT_PX },
    );
  }
}
