import type { BenchArrays, Crossing } from "./bench-arrays";
import { carryOut } from "./carry-out";
import type { BoardDocument, FileCommand, FileEntry, FileEvent } from "./file-document";
import { Findings } from "./findings";
import { digestOf } from "./sha";
import { obey } from "./supervise";

export interface FileTrip {
  tick: number;
  reason: string;
}

/** The whole state of a board at a tick edge, but for its history. */
export type BoardCheckpoint = ReturnType<FileBoard["checkpoint"]>;

const MOST_ENTRIES = 2000;

/** A board without a server: the ticks, commands at tick edges, a log, a digest. */
export class FileBoard<D extends BoardDocument = BoardDocument> {
  readonly document: D;
  readonly arrays: BenchArrays;
  tick = 0;
  trip: FileTrip | undefined;
  log: FileEntry[] = [];
  /** The severities of the faults that act, each with its variant and the tick at which it began. */
  faults = new Map<string, { severity: number; variant: number; since: number }>();
  driving: Record<string, string> = {};
  values: Record<string, number> = {};
  /** The values that the supervisor sets, as they are now. */
  supervised: Record<string, unknown> = {};
  running = new Set<number>();
  /** The commands that have taken effect, each with its tick. */
  done: [number, FileCommand][] = [];
  /** Called with each new entry of the log. */
  heard: ((entry: FileEntry) => void) | undefined;
  private began = 0;
  private readonly findings: Findings;
  private used = new Set<string>();
  private pending: FileEvent[] = [];
  private seq = 0;

  /** It is as before its first tick once it has been reset. */
  constructor(document: D, arrays: BenchArrays) {
    this.document = document;
    this.arrays = arrays;
    this.findings = new Findings(document);
  }

  /** Go back to tick 0, with these events waiting. */
  reset(events: readonly FileEvent[] = []): void {
    const { present, running, values, wirings } = this.document;
    this.arrays.reset();
    this.tick = 0;
    this.began = 0;
    this.seq = 0;
    this.trip = undefined;
    this.log = [];
    this.done = [];
    this.faults = new Map(Object.entries(present));
    this.used = new Set();
    this.driving = { ...wirings.driving };
    this.values = Object.fromEntries(Object.entries(values).map(([path, { value }]) => [path, value]));
    this.supervised = this.document.supervisor?.values ?? {};
    this.pending = events.map((event) => ({ ...event }));
    this.running = new Set(running);
    this.arrays.link(this.running);
    for (const entry of this.document.log) this.note(entry, entry.tick);
  }

  /** A copy of all that the next ticks depend on. */
  checkpoint() {
    const { tick, trip, driving, values, supervised, seq } = this;
    const faults = new Map(this.faults);
    const running = new Set(this.running);
    const used = new Set(this.used);
    const pending = this.pending.map((event) => ({ ...event }));
    const done = [...this.done];
    const numbers = this.arrays.copy();
    return { tick, trip, driving, values, supervised, seq, faults, running, used, pending, done, numbers };
  }

  /** Go to a checkpoint; the past begins there, or at an earlier tick that the history has. */
  restore(kept: BoardCheckpoint, began = kept.tick): void {
    const { numbers, pending, done, faults, running, used, ...rest } = kept;
    Object.assign(this, rest, { began });
    this.done = [...done];
    this.faults = new Map(faults);
    this.running = new Set(running);
    this.used = new Set(used);
    this.pending = pending.map((event) => ({ ...event }));
    this.arrays.paste(numbers);
    this.arrays.link(this.running);
  }

  /** Let a command wait for its moment. */
  wait(event: FileEvent): void {
    this.pending = [...this.pending, event];
  }

  /** The commands that wait. */
  get waiting(): readonly FileEvent[] {
    return this.pending;
  }

  /** Run ticks; fewer when the board trips. */
  advance(n: number): number {
    const first = this.tick;
    const end = first + n;
    const { look_every: every, reasons, sensors, supervisor } = this.document;
    while (this.tick < end) {
      this.applyDue();
      if (this.trip) break;
      const stop = Math.min(end, this.tick - (this.tick % every) + every, this.upcoming);
      const watched: number[][] = this.pending.flatMap(({ tick, when }) => (when && tick === null ? [when] : []));
      if (supervisor) watched.push([supervisor.place, 1, 0.5]);
      const { ran, why } = this.arrays.run(stop - this.tick, this.tick, watched);
      if (why !== 0) this.tell(this.tick + ran - 1);
      for (const name of [...Object.values(this.driving), sensors.measuring]) this.used.add(name);
      this.tick += ran;
      if (why === reasons.tripped || why === reasons.watched) this.meet();
      if (why === reasons.tripped) this.stop(this.cause());
      else if (this.tick % every === 0) {
        const lost = this.lost();
        if (lost) this.stop(`the state of ${lost} is no longer finite`);
      }
    }
    return this.tick - first;
  }

  /** Let a command take effect at this tick edge. */
  apply(command: FileCommand, actor = "you"): void {
    this.obey();
    const { kind, text, old, now } = carryOut(this, command);
    this.done.push([this.tick, command]);
    this.note({ actor, kind, text, command, old, new: now });
  }

  /** Let a command take effect at a tick, now or later; a command that is not allowed has no effect. */
  await(tick: number, command: FileCommand): void {
    if (tick > this.tick) {
      this.pending.push({ tick, command });
      return;
    }
    try {
      this.apply(command, "scenario");
    } catch {
      // such as a heal of the cause of a trip
    }
  }

  /** Write an entry of the log. */
  note(entry: Omit<FileEntry, "seq" | "tick">, tick = this.tick): void {
    this.seq += 1;
    const noted = { seq: this.seq, tick, ...entry };
    this.log = [...this.log.slice(-MOST_ENTRIES), noted];
    this.heard?.(noted);
  }

  /** The oldest tick of the past. */
  get oldest(): number {
    const { capacity, widest } = this.document.history;
    return Math.max(this.began, this.tick - capacity + widest);
  }

  /** Least and largest values of signals in each column of a span of ticks. */
  cut(signals: readonly number[], start: number, stop: number, columns: number): Float32Array {
    return this.arrays.cut(signals, [this.oldest, this.tick], [start, stop], columns);
  }

  /** The ticks of a span at which a signal crosses, at most so many. */
  crossings(signal: number, span: [number, number], crossing: Crossing, most: number): number[] {
    return this.arrays.crossings(signal, [this.oldest, this.tick], span, crossing, most);
  }

  /** The value of a traced signal after the last tick. */
  latest(signal: number): number {
    return this.arrays.w.view[this.document.reserved + signal];
  }

  /** The SHA-256 over all outputs since tick 0, as the server and the command line know it. */
  async digest(): Promise<string> {
    const { blocks, controllers, sensors } = this.document;
    const aside = [...Object.keys(controllers), ...sensors.all].filter((name) => !this.used.has(name));
    const counted = [...new Set(blocks)].filter((block) => block && !aside.includes(block)).sort();
    const words = this.arrays.joined(counted);
    return digestOf(counted.flatMap((block, k) => [`${block}\0`, words.slice(2 * k, 2 * k + 2)]));
  }

  private get upcoming(): number {
    return Math.min(...this.pending.flatMap(({ tick }) => tick ?? []));
  }

  /** Carry out the commands due at this tick. */
  applyDue(): void {
    this.obey();
    const due = this.pending.filter(({ tick }) => tick !== null && tick <= this.tick);
    if (due.length === 0) return;
    this.pending = this.pending.filter((event) => !due.includes(event));
    for (const event of due) {
      if (event.when) this.pending.push({ ...event, tick: null });
      else {
        try {
          this.apply(event.command, event.actor ?? "scenario");
        } catch (error) {
          this.note({ actor: "board", kind: "refused", text: String((error as Error).message), old: null, new: null });
        }
      }
    }
  }

  /** Let the commands whose conditions hold take effect at this tick. */
  private meet(): void {
    this.pending = this.pending.map((event) => {
      if (event.tick !== null || !event.when) return event;
      const [place, sign, threshold] = event.when;
      const holds = sign * (this.arrays.w.view[place] - threshold) > 0;
      return holds ? { ...event, when: undefined, tick: this.tick } : event;
    });
  }

  private tell(tick: number): void {
    const signals = this.arrays.w.view.subarray(this.document.reserved);
    for (const finding of this.findings.look(signals, this.arrays.last.view))
      this.note({ actor: "board", ...finding }, tick);
  }

  /** Carry out the request of the supervisor, before any command at this tick: a consequence of the samples. */
  private obey(): void {
    for (const { kind, text, old, now } of obey(this)) this.note({ actor: "supervisor", kind, text, old, new: now });
  }

  private cause(): string {
    const code = this.document.guards.map((place) => this.arrays.w.view[place]).find((value) => value !== 0);
    return this.document.trip_reasons[String(code)] ?? "a guard stopped the board";
  }

  /** Trip at this tick for a reason that no signal shows. */
  makeSafe(reason: string): void {
    this.trip = { tick: this.tick, reason };
    for (const place of this.document.disengaged) this.arrays.w.view[place] = 0;
  }

  private stop(reason: string): void {
    this.makeSafe(reason);
    this.note({ actor: "board", kind: "tripped", text: `tripped: ${reason}`, old: null, new: null });
  }

  /** The first block whose state is no longer finite; a controller in shadow does not count. */
  private lost(): string | undefined {
    const state = this.arrays.s.view;
    if (state.every(Number.isFinite)) return undefined;
    const endless = new Set([...this.document.endless].map(Number));
    const driving = Object.values(this.driving);
    const found = this.document.rows.find(({ key, s: [from, to] }) => {
      if (key in this.document.controllers && !driving.includes(key)) return false;
      for (let i = from; i < to; i += 1) if (!Number.isFinite(state[i]) && !endless.has(i)) return true;
      return false;
    });
    return found?.prefix;
  }
}
