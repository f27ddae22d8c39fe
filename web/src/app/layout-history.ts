import type { DockviewApi, SerializedDockview } from "dockview-react";
import { useView } from "../bench/view-store";

/** A layout as it stood, and when it was left. */
interface Kept {
  name: string;
  layout: SerializedDockview;
  at: number;
}

type Arrange = (name: string, layout: SerializedDockview) => void;

const MOST = 50;
const SETTLES_MS = 250;

/** Parts of a stored layout that name the active tab: a change of tab is no change of the layout. */
const IN_FRONT = new Set(["activeView", "activeGroup", "view"]);

/** The shape of a layout, as text to compare. */
const shapeOf = ({ name, layout }: Pick<Kept, "name" | "layout">): string =>
  JSON.stringify([name, layout], (key, value) =>
    IN_FRONT.has(key) ? undefined : key === "size" ? Math.round(value) : value,
  );

/** Whether the dock has another size: all panels then change theirs, without a request of the user. */
const isResized = ({ grid: a }: SerializedDockview, { grid: b }: SerializedDockview): boolean =>
  a.width !== b.width || a.height !== b.height;

/** Changes of the layout that can be taken back and made again. */
export class LayoutHistory {
  private past: Kept[] = [];
  private future: Kept[] = [];
  private now: Kept | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** The next change is not the user's: a layout was put there. */
  private isOurs = true;
  private dock: DockviewApi | undefined;

  /** Watch a dock from here on. */
  watch(dock: DockviewApi): void {
    this.dock = dock;
    this.forget();
    dock.onDidLayoutChange(() => this.settleSoon());
  }

  /** Begin anew with the layout that is being put there. */
  forget(): void {
    this.past = [];
    this.future = [];
    this.adopt();
  }

  /** When the change that `way` takes was made. */
  lastAt(way: "undo" | "redo"): number | undefined {
    this.settle();
    return (way === "undo" ? this.past : this.future).at(-1)?.at;
  }

  /** Go back to the layout before, or forward again. */
  go(way: "undo" | "redo", arrange: Arrange): void {
    this.settle();
    const [from, to] = way === "undo" ? [this.past, this.future] : [this.future, this.past];
    const wanted = from.pop();
    if (!wanted || !this.now) return;
    to.push({ ...this.now, at: wanted.at });
    arrange(wanted.name, wanted.layout);
    this.adopt();
  }

  /** Adopt the next settled layout: the user has not made it, so it cannot be undone. */
  private adopt(): void {
    this.isOurs = true;
    this.settleSoon();
  }

  private settleSoon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.settle(), SETTLES_MS);
  }

  private settle(): void {
    clearTimeout(this.timer);
    if (!this.dock) return;
    const next: Kept = { name: useView.getState().layout, layout: this.dock.toJSON(), at: performance.now() };
    const isChange = this.now && shapeOf(next) !== shapeOf(this.now);
    if (this.now && isChange && !this.isOurs && !isResized(this.now.layout, next.layout)) {
      this.past = [...this.past, { ...this.now, at: next.at }].slice(-MOST);
      this.future = [];
    }
    this.isOurs = false;
    this.now = next;
  }
}

export const layoutHistory = new LayoutHistory();
