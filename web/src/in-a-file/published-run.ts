import { formatCount, formatSi } from "../ui/format";
import { button, element, write } from "./dom";
import type { FileBench } from "./file-bench";
import type { FilePublished } from "./file-document";

/** Computing between two moments at which the page may draw, ms. */
const SLICE_MS = 40;
const SLICE_TICKS = 512;
const SHOWN_OF_DIGEST = 16;

/** The claim of a scenario with its figures, and its run anew in this browser: is its digest the published digest? */
export class PublishedRun {
  readonly root = element("section", { className: "panel published" }, element("h2", {}, "Published run"));
  /** Whether the run is being computed; commands wait until it is over. */
  isComputing = false;
  private readonly bench: FileBench;
  private readonly published: FilePublished;
  private readonly press = button("Recompute here", () => void this.toggle(), "main");
  private readonly progress = element("progress", { max: 1, value: 0, hidden: true });
  private readonly result = element("p", { className: "result", role: "status" });

  constructor(bench: FileBench, published: FilePublished) {
    this.bench = bench;
    this.published = published;
    const { claim, source, verdict, digest, ticks, expectations } = published;
    if (claim) this.root.append(element("p", {}, claim));
    const word = verdict ? element("b", {}, verdict) : "";
    this.root.append(element("p", { className: "note" }, source, source && verdict ? ". Verdict: " : "", word));
    if (expectations.length > 0) this.root.append(figures(expectations));
    const own = element("code", { title: digest }, `${digest.slice(0, SHOWN_OF_DIGEST)}…`);
    this.root.append(
      element("p", {}, "Digest of ", formatCount(ticks, "tick"), ": ", own),
      element("div", { className: "line" }, this.press, this.progress),
      this.result,
    );
    this.press.title = "Starts the bench anew and computes the whole run as fast as this browser can";
  }

  private async toggle(): Promise<void> {
    if (this.isComputing) {
      this.isComputing = false;
      return;
    }
    await this.compute();
  }

  /** Compute the run, slice by slice. */
  private async compute(): Promise<void> {
    const { bench, published, progress } = this;
    bench.reset();
    this.begin(true);
    write(this.result, "");
    const began = performance.now();
    let isOver = false;
    while (this.isComputing && !isOver) {
      const until = performance.now() + SLICE_MS;
      while (!isOver && performance.now() < until) {
        const ran = bench.advance(Math.min(SLICE_TICKS, published.ticks - bench.tick));
        isOver = ran === 0 || bench.tick >= published.ticks;
      }
      progress.value = bench.tick / published.ticks;
      await new Promise((resolve) => setTimeout(resolve));
    }
    const seconds = (performance.now() - began) / 1000;
    if (isOver) await this.compare(seconds);
    this.begin(false);
  }

  private begin(isComputing: boolean): void {
    this.isComputing = isComputing;
    this.progress.hidden = !isComputing;
    write(this.press, isComputing ? "Stop" : "Recompute here");
  }

  private async compare(seconds: number): Promise<void> {
    const digest = await this.bench.digest();
    const isSame = digest === this.published.digest;
    const word = isSame ? "✓ The same digest" : "✗ Another digest";
    write(this.result, `${word}: ${digest.slice(0, SHOWN_OF_DIGEST)}…, in ${formatSi(seconds, "s", 2)}`);
    this.result.title = digest;
    this.result.dataset.same = String(isSame);
  }
}

function figures(expectations: FilePublished["expectations"]): HTMLElement {
  const head = element("tr", {}, ...["Figure", "Expected", "Measured"].map((word) => element("th", {}, word)));
  const rows = expectations.map(({ metric, published, expected, measured, ok }) => {
    const name = element("td", { title: published ? `Published: ${published}` : "" }, metric);
    const cell = element("td", {}, `${ok ? "✓" : "✗"} ${measured}`);
    cell.dataset.same = String(ok);
    return element("tr", {}, name, element("td", {}, expected), cell);
  });
  return element("div", { className: "figures" }, element("table", {}, head, ...rows));
}
