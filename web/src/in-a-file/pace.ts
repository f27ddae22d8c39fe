/** Most wall time between two pictures that counts: a page that was out of sight continues at the same tick. */
const MOST_LAG_MS = 100;
/** Most time of computing between two pictures. */
const MOST_MS = 14;
const SLICE = 64;

/** Turns the time of the wall into ticks, as many as the pace asks for and the machine computes between two pictures. */
export class Pace {
  /** Device time per wall time; null is as fast as the machine can. */
  scale: number | null;
  isRunning = true;
  private readonly dtMs: number;
  private due = 0;
  private last: number | undefined;

  constructor(dtMs: number, scale: number | null) {
    this.dtMs = dtMs;
    this.scale = scale;
  }

  /** Run the ticks of a picture; `advance` says how many of those it was asked for it has run. */
  run(now: number, advance: (n: number) => number): void {
    const passed = Math.min(now - (this.last ?? now), MOST_LAG_MS);
    this.last = now;
    if (!this.isRunning) return;
    this.due = this.scale === null ? Number.POSITIVE_INFINITY : this.due + (passed * this.scale) / this.dtMs;
    const until = performance.now() + MOST_MS;
    while (this.due >= 1) {
      const ran = advance(Math.min(SLICE, Math.floor(this.due)));
      this.due -= ran;
      if (ran === 0 || performance.now() > until) {
        this.due = 0; // time that cannot be caught up is dropped
        return;
      }
    }
  }
}
