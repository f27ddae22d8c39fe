import type { Crossing } from "../in-a-file/bench-arrays";
import type { FileBench } from "../in-a-file/file-bench";
import type { Trigger } from "../stream/wire";

/** Windows of the past in which the first crossing is sought. */
const WINDOWS = 51;

/** The crossing that a sweep chooses, if any, and the state of the trigger. */
export interface Swept {
  tick: number | undefined;
  waiting: boolean;
  triggered: boolean;
}

/** The time base of a triggered panel: it chooses the crossing to show, as the server does. */
export class Sweep {
  /** Ticks of the window before the crossing. */
  readonly before: number;
  private readonly file: FileBench;
  private readonly signal: number;
  private readonly spec: Trigger;
  private readonly window: number;
  private readonly crossing: Crossing;
  private next: number;
  private waiting: number[] = [];
  private shown: number | undefined;
  private armed = true;

  constructor(file: FileBench, signal: number, spec: Trigger, window: number) {
    this.file = file;
    this.signal = signal;
    this.spec = spec;
    this.window = window;
    this.before = Math.round(spec.position * window);
    const ways = waysOf(spec);
    this.crossing = { ways, outside: spec.edge === "leaves", ready: new BigInt64Array(ways.length) };
    this.next = this.isSingle ? file.tick : file.tick - WINDOWS * window;
  }

  get isAuto(): boolean {
    return this.spec.sweep === "auto";
  }

  /** Wait for the next crossing. */
  rearm(): void {
    if (!this.isSingle) return;
    this.restart(this.file.tick);
    this.waiting = [];
    this.armed = true;
  }

  /** The crossing to show now. */
  update(): Swept {
    const { tick: head } = this.file;
    const after = this.window - this.before;
    if (this.shown !== undefined && this.shown > head) {
      this.shown = undefined; // the bench went back in time
      this.waiting = [];
    }
    if (!this.isSingle) this.waiting = [...this.waiting, ...this.scan(Number.POSITIVE_INFINITY)];
    else if (this.armed && this.waiting.length === 0) this.waiting = this.scan(1);
    const complete = this.waiting.filter((tick) => tick + after <= head);
    if (complete.length > 0) {
      this.waiting = this.waiting.slice(complete.length);
      this.shown = complete[complete.length - 1];
      this.armed = !this.isSingle;
    }
    const { shown } = this;
    if (this.isSingle) return { tick: shown, waiting: this.armed, triggered: shown !== undefined };
    const isLate = shown === undefined || head - shown > 2 * this.window + after;
    return isLate
      ? { tick: this.isAuto ? undefined : shown, waiting: true, triggered: false }
      : { tick: shown, waiting: false, triggered: true };
  }

  /** The place of a crossing between two ticks, on the line between them. */
  exact(tick: number): number {
    const { file, signal, spec } = this;
    if (tick - 1 < file.oldest) return tick;
    const [before, after] = file.cut([signal], tick - 1, tick + 1, 2);
    const [least, most] = [Math.min(before, after), Math.max(before, after)];
    const levels = [spec.level, spec.upper ?? Number.POSITIVE_INFINITY];
    const crossed = levels.filter((level) => least <= level && level <= most);
    if (before === after || crossed.length === 0) return tick;
    return tick - 1 + Math.min(...crossed.map((level) => (level - before) / (after - before)));
  }

  private get isSingle(): boolean {
    return this.spec.sweep === "single";
  }

  /** The crossings since the last scan, at most so many. */
  private scan(most: number): number[] {
    const { file } = this;
    if (this.next < file.oldest || this.next > file.tick)
      this.restart(Math.min(Math.max(this.next, file.oldest), file.tick)); // forgotten by now, or back in time
    const found = file.crossings(this.signal, [this.next, file.tick], this.crossing, most);
    this.next = found.length === most ? found[found.length - 1] + 1 : file.tick;
    return found;
  }

  private restart(tick: number): void {
    this.next = tick;
    this.crossing.ready.fill(0n);
  }
}

/** For each way of crossing its target, and the numbers beyond which the signal has been back. */
function waysOf({ edge, level, upper, hysteresis }: Trigger): number[][] {
  const up = [level, Number.POSITIVE_INFINITY, level - hysteresis, Number.POSITIVE_INFINITY];
  const down = [Number.NEGATIVE_INFINITY, level, Number.NEGATIVE_INFINITY, level + hysteresis];
  const end = upper ?? Number.POSITIVE_INFINITY;
  if (edge === "rising") return [up];
  if (edge === "falling") return [down];
  if (edge === "either") return [up, down];
  const sign = edge === "leaves" ? -1 : 1;
  return [[level, end, level - sign * hysteresis, end + sign * hysteresis]];
}
