import type { FileBench } from "../in-a-file/file-bench";
import { Pace } from "../in-a-file/pace";

/** Wall time at the time scale that is left before a command that waits, to see the moment before. */
const SHORTLY_S = 2;
const WINDOW_MS = 1000;

type Reason = "quiet_lead" | "skip";

/** The time of a bench: it runs, pauses and skips, keeps a pace, and pauses at the end of the scenario. */
export class LiveTime {
  isRunning = false;
  /** Device time per wall time; null is as fast as possible. */
  scale: number | null;
  /** Why it runs as fast as possible now, if it does whatever its time scale. */
  reason: Reason | null = null;
  /** The tick at which the scenario ends, until it has. */
  endsAt: number;
  private readonly file: FileBench;
  private readonly pace: Pace;
  private fastTo = 0;
  private awaited = 0;
  private seen: { now: number; tick: number }[] = [];

  constructor(file: FileBench, scale: number | null, endsAt: number | null) {
    this.file = file;
    this.scale = scale;
    this.endsAt = endsAt ?? Number.POSITIVE_INFINITY;
    this.pace = new Pace(file.document.dt_ms, scale);
  }

  /** Device time per wall time over the last second. */
  get achieved(): number {
    const [first, last] = [this.seen[0], this.seen.at(-1)];
    if (!this.isRunning || !first || !last || last.now <= first.now) return 0;
    return ((last.tick - first.tick) * this.file.document.dt_ms) / (last.now - first.now);
  }

  /** Run the ticks that are due; whether the scenario has ended with them. */
  turn(now: number, follow: () => void): boolean {
    const { file } = this;
    this.pace.isRunning = this.isRunning;
    this.pace.scale = this.reason ? null : this.scale;
    this.pace.run(now, (n) => {
      const end = Math.min(this.endsAt, this.reason ? this.fastTo : Number.POSITIVE_INFINITY);
      const ran = file.advance(Math.max(0, Math.min(n, end - file.tick)));
      follow();
      if (this.reason && (file.tick >= this.fastTo || this.conditions < this.awaited)) this.slow();
      return this.isRunning ? ran : 0;
    });
    this.seen = [...this.seen.filter((one) => now - one.now < WINDOW_MS), { now, tick: file.tick }];
    if (file.trip) this.isRunning = false;
    if (!this.isRunning || file.tick < this.endsAt) return false;
    this.isRunning = false;
    this.endsAt = Number.POSITIVE_INFINITY;
    return true;
  }

  /** Go on at the time scale. */
  slow(): void {
    this.reason = null;
    this.awaited = 0;
    this.seen = [];
  }

  /** Begin as fast as possible to shortly before the first command that waits for a tick, in words; nothing without one. */
  lead(): string | undefined {
    const tick = Math.min(...this.moments);
    if (this.conditions > 0 || !Number.isFinite(tick)) return undefined;
    const words = this.hurry("quiet_lead", tick);
    return this.reason ? `quiet lead: ${words}` : undefined;
  }

  /** Run on to shortly before a tick, a command that waits, or the end of the scenario; in words. */
  skip(before: number | null): string {
    const { tick } = this.file;
    if (before !== null && before <= tick) throw new Error(`tick ${before} has passed, the bench is at ${tick}`);
    const next = before ?? Math.min(...this.moments.filter((one) => one > tick + this.shortly));
    if (Number.isFinite(next)) return this.hurry("skip", next);
    if (this.conditions === 0) {
      if (!Number.isFinite(this.endsAt)) throw new Error("nothing waits, and the scenario has no end");
      return this.hurry("skip", this.endsAt);
    }
    this.reason = "skip";
    this.fastTo = this.endsAt;
    this.awaited = this.conditions;
    return "as fast as possible until what waits takes effect";
  }

  private hurry(reason: Reason, tick: number): string {
    this.fastTo = tick - this.shortly;
    this.reason = this.fastTo > this.file.tick ? reason : null;
    return `as fast as possible to shortly before tick ${tick}`;
  }

  private get shortly(): number {
    const ticks = Math.round((SHORTLY_S * 1000 * (this.scale ?? 0)) / this.file.document.dt_ms);
    return Math.max(1, ticks);
  }

  private get moments(): number[] {
    return this.file.waiting.flatMap(({ tick, when }) => (tick !== null && !when ? [tick] : []));
  }

  private get conditions(): number {
    return this.file.waiting.filter(({ when }) => when).length;
  }
}
