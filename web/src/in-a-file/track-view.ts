import { formatCount, formatNumber, formatSi } from "../ui/format";
import { button, element, write } from "./dom";
import type { TrackDocument, TrackRow } from "./track-document";
import { TrackRun } from "./track-run";

const SHOWN_OF_DIGEST = 16;

/** The published rows of a track, and their cases anew in this browser, one at a time: are the digests the same? */
export class TrackView {
  readonly root: HTMLElement;
  private readonly module: WebAssembly.Module;
  private readonly track: TrackDocument["track"];
  private isComputing = false;
  private readonly press = button("Recompute here", () => void this.toggle(), "main");
  private readonly progress = element("progress", { max: 1, value: 0, hidden: true });
  private readonly told = element("p", { role: "status" });
  private readonly cells = new Map<string, HTMLElement>();

  constructor(module: WebAssembly.Module, { title, summary, index, version, track }: TrackDocument) {
    this.module = module;
    this.track = track;
    this.press.disabled = true; // a bench computes the first case at first
    const up = index ? element("a", { href: index }, "All exhibits") : "";
    const words = element("p", { className: "note" }, `${summary} ${track.note}`);
    const foot = `Each diagnoser is given the voltage and the displacement of ${formatCount(track.cases.length, "device")}. The digest of a row is over the bits of its probabilities at every sample. Made by CombBench ${version}.`;
    this.root = element(
      "main",
      { className: "track" },
      element("header", {}, up, element("h1", {}, title), words),
      element(
        "section",
        { className: "panel" },
        element("div", { className: "line" }, this.press, this.progress),
        this.told,
        element("div", { className: "figures" }, this.table()),
      ),
      element("footer", { className: "remark" }, foot),
    );
  }

  /** Compute the first case, and tell how long all of them need. */
  async estimate(): Promise<void> {
    const { cases, samples } = this.track;
    const run = new TrackRun(this.module, this.track);
    const began = performance.now();
    await run.next();
    const seconds = ((performance.now() - began) / 1000) * (samples / cases[0].samples);
    this.press.disabled = false;
    this.tell(
      `${formatCount(cases.length, "case")}, ${formatCount(samples, "sample")}: about ${formatSi(seconds, "s", 1)} in this browser`,
    );
  }

  private table(): HTMLElement {
    const head = ["Diagnoser", "Log score", "Published digest", "Here"].map((word) => element("th", {}, word));
    return element("table", {}, element("tr", {}, ...head), ...this.track.rows.map((row) => this.row(row)));
  }

  private row({ unit, title, log_score: score, digest }: TrackRow): HTMLElement {
    const here = element("td");
    this.cells.set(unit, here);
    const own = element("code", { title: digest }, `${digest.slice(0, SHOWN_OF_DIGEST)}…`);
    const scored = score === null ? "" : formatNumber(score, 3);
    const figures = [element("td", {}, title), element("td", {}, scored), element("td", {}, own)];
    return element("tr", {}, ...figures, here);
  }

  private tell(text: string): void {
    if (!this.isComputing) write(this.told, text);
  }

  private async toggle(): Promise<void> {
    if (this.isComputing) {
      this.isComputing = false;
      return;
    }
    this.begin(true);
    for (const cell of this.cells.values()) write(cell, "");
    const run = new TrackRun(this.module, this.track);
    const began = performance.now();
    const count = this.track.cases.length;
    while (this.isComputing && run.done < count) {
      await run.next();
      this.progress.value = run.done / count;
      write(this.told, `Case ${run.done} of ${count}`);
      await new Promise((resolve) => setTimeout(resolve)); // the page draws, and the button is heard
    }
    const seconds = (performance.now() - began) / 1000;
    const isOver = run.done === count;
    const same = isOver ? await this.compare(run) : 0;
    this.begin(false);
    const rows = this.track.rows.length;
    this.tell(
      isOver
        ? `${same === rows ? "✓" : "✗"} ${same} of ${rows} digests are the published ones, in ${formatSi(seconds, "s", 2)}`
        : `Stopped after ${formatCount(run.done, "case")}`,
    );
  }

  private begin(isComputing: boolean): void {
    this.isComputing = isComputing;
    this.progress.hidden = !isComputing;
    write(this.press, isComputing ? "Stop" : "Recompute here");
  }

  /** Show each digest beside the published one; how many are the same. */
  private async compare(run: TrackRun): Promise<number> {
    let same = 0;
    for (const { unit, digest } of this.track.rows) {
      const found = await run.digest(unit);
      const cell = this.cells.get(unit) as HTMLElement;
      write(cell, `${found === digest ? "✓" : "✗"} ${found.slice(0, SHOWN_OF_DIGEST)}…`);
      cell.title = found;
      cell.dataset.same = String(found === digest);
      if (found === digest) same += 1;
    }
    return same;
  }
}
