import type { LogEntry } from "../api/types";
import { flagWords } from "../bench/flag-words";
import { formatMoment } from "../ui/format";
import { element } from "./dom";
import type { FileBench } from "./file-bench";

const SHOWN = 60;

/** The newest entries of the log of a bench, the latest first. */
export class EventList {
  readonly root = element("section", { className: "panel list events" }, element("h2", {}, "Events"));
  private readonly bench: FileBench;
  private readonly list = element("ol");
  private known: unknown;

  constructor(bench: FileBench) {
    this.bench = bench;
    this.root.append(this.list);
  }

  /** Show the log of now. */
  show(): void {
    const { log, document } = this.bench;
    if (log === this.known) return;
    this.known = log;
    const newest = log.slice(-SHOWN).reverse();
    this.list.replaceChildren(
      ...newest.map((entry) => {
        const words = entry.command ? flagWords(entry as unknown as LogEntry) : entry.text;
        const time = element("small", { title: `tick ${entry.tick}` }, formatMoment(entry.tick * document.dt_ms));
        return element("li", { title: entry.text }, time, " ", words);
      }),
    );
    for (const [i, { kind }] of newest.entries()) (this.list.children[i] as HTMLElement).dataset.kind = kind;
  }
}
