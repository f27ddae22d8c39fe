import type { FileBench } from "./file-bench";

/** The ticks that all panels show: the newest, or a span of the past that a hand has moved to. */
export class TimeWindow {
  windowMs: number;
  private readonly bench: FileBench;
  private held: { start: number; end: number } | undefined;
  private readonly listeners: (() => void)[] = [];

  constructor(bench: FileBench, windowMs: number) {
    this.bench = bench;
    this.windowMs = windowMs;
  }

  get isHeld(): boolean {
    return this.held !== undefined;
  }

  get span(): { start: number; end: number } {
    const end = this.bench.tick;
    return this.held ?? { start: end - this.windowMs / this.bench.document.dt_ms, end };
  }

  look = (start: number, end: number): void => {
    this.held = { start, end };
    this.tell();
  };

  goLive = (): void => {
    this.held = undefined;
    this.tell();
  };

  choose(windowMs: number): void {
    this.windowMs = windowMs;
    this.goLive();
  }

  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Ask the panels to draw anew. */
  tell(): void {
    for (const listener of this.listeners) listener();
  }
}
