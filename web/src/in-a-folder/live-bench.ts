import type { components } from "../api/schema";
import type { Bench, Command, LogEntry } from "../api/types";
import { commandWords } from "../in-a-file/command-words";
import type { FileBench } from "../in-a-file/file-bench";
import type { FileCommand, FileEntry, FileEvent } from "../in-a-file/file-document";
import type { Status } from "../stream/wire";
import { LiveTime } from "./live-time";
import { type BoardCommand, fileEvent, type RunCommand } from "./page-command";
import { scoresOf } from "./scores";
import { carry, Track } from "./track";
import { Changes, inverseOf, stateOf } from "./undo";

type Schemas = components["schemas"];

const YOU = "you";
const KEPT = 4000;

/** A bench in a folder, as a server describes it: the bench of a file with its time, its past and its events. */
export class LiveBench {
  readonly id: string;
  readonly file: FileBench;
  readonly time: LiveTime;
  name = "";
  origin: Omit<Schemas["Origin"], "is_past"> | undefined;
  events: LogEntry[] = [];
  track = new Track();
  /** Counts the changes of the scenario's document. */
  edition = 1;
  /** Counts its histories: a return to another tick begins one, and its pictures are new. */
  history = 0;
  /** The number of the last event that is of the bench whose past it shows. */
  takenOver = 0;
  private readonly changes = new Changes();
  private readonly fixed: Bench;
  private readonly created = new Date().toISOString();
  private last = 0;

  constructor(id: string, file: FileBench, fixed: Bench, scale = fixed.time_scale) {
    this.id = id;
    this.file = file;
    this.fixed = fixed;
    this.time = new LiveTime(file, scale, fixed.samples);
    file.heard = this.hear;
  }

  /** Begin at tick 0. */
  begin(): void {
    this.track.follow(this.file);
    for (const entry of this.file.document.log) this.add(entry);
    this.time.isRunning = true;
    this.say("board", "opened", "running");
    this.lead();
  }

  /** Show a bench of the same document at a tick of its past. */
  stand(of: LiveBench, tick: number, window: number, isBefore = false): void {
    const { file } = this;
    file.heard = undefined;
    const isSeen = of.file.oldest <= Math.max(0, tick - window) && tick <= of.file.tick;
    const began = isSeen ? of.file.oldest : undefined;
    if (isSeen && of !== this) file.adopt(of.file);
    of.track.replay(file, tick, { from: isSeen ? tick : Math.max(0, tick - window), began, isBefore });
    this.track = of.track.until(file);
    this.history += 1;
    file.heard = this.hear;
    this.edition += 1;
    this.time.isRunning = false;
    this.changes.forget();
    const end = isBefore ? tick : tick + 1;
    const led = this.events.filter((event) => event.seq <= this.takenOver && event.tick < end);
    const text = `shows tick ${tick} as it was`;
    this.say("api", "restored", text, { now: Math.max(0, ...led.map(({ seq }) => seq)) });
  }

  /** Run the ticks that are due; whether anything may have changed. */
  turn(now: number): void {
    if (!this.time.turn(now, () => this.track.follow(this.file))) return;
    this.say("scenario", "finished", "scenario finished; run to continue");
  }

  /** Carry out a command of the page; words where that cannot be. */
  execute(command: Command): void {
    if ("kind" in command) this.run(command as RunCommand);
    else this.change(command as BoardCommand);
  }

  /** Whether it shows the moment still at which it was made. */
  get isPast(): boolean {
    const { origin, file, track } = this;
    return origin !== undefined && file.tick === origin.tick && !track.hasDeedsSince(origin.tick);
  }

  private change(command: BoardCommand): void {
    const { file } = this;
    const event = fileEvent(file, command);
    const before = stateOf(file);
    this.act(event);
    if (event.tick !== null || event.when) {
      this.say(YOU, "scheduled", `waiting: ${commandWords(event.command)}`, { command });
      return;
    }
    const slot = "switch" in event.command ? file.document.wirings.slots[event.command.switch] : "";
    const { seq, text } = this.events[this.events.length - 1];
    this.changes.add({ seq, text, command: event.command, back: inverseOf(event.command, before, slot) });
  }

  private act(event: FileEvent): void {
    const { file } = this;
    const { tick } = file;
    carry(file, event, YOU);
    this.track.note({ tick, actor: YOU, event });
    this.edition += 1;
    this.time.slow();
  }

  private run(command: RunCommand): void {
    const { time, file } = this;
    const { tick } = file;
    const note = (text: string, more = {}) => this.say(YOU, command.kind ?? "", text, { command, ...more });
    if (command.kind === "pause") {
      time.isRunning = false;
      note("paused");
    } else if (command.kind === "time_scale") {
      const old = time.scale;
      time.slow();
      time.scale = command.value;
      const text = command.value === null ? "time runs as fast as possible" : `time scale set to ${command.value}`;
      note(text, { old, now: command.value });
    } else if (command.kind === "undo" || command.kind === "redo") {
      const text = this.changes.move(command.kind, (one) => this.act({ tick: null, command: one }));
      this.say(YOU, command.kind === "undo" ? "undone" : "redone", text);
    } else if (command.kind === "reset") this.reset(command.values ?? {}, command.before_tick ?? null);
    else if (file.trip) throw new Error(`the board has tripped: ${file.trip.reason}`);
    else if (command.kind === "start") {
      time.isRunning = true;
      note("started");
    } else if (command.kind === "fast_forward") {
      const text = time.skip(command.before_tick ?? null);
      time.isRunning = true;
      note(text);
    } else if (command.kind === "step" || command.kind === "step_period") {
      const period = this.fixed.drive_period_ticks;
      const ticks = command.kind === "step" ? (command.ticks ?? 1) : period && Math.max(1, Math.round(period));
      if (!ticks) throw new Error("the reference has no period");
      time.isRunning = false;
      const ran = file.advance(ticks);
      this.track.follow(file);
      const words = ran < ticks ? `stepped ${ran} of ${ticks} ticks` : `stepped ${ticks} tick${ticks === 1 ? "" : "s"}`;
      this.say(YOU, command.kind, words, { command, tick });
    } else throw new Error("a bench without a server cannot do that");
  }

  private reset(values: object, before: number | null): void {
    if (Object.keys(values).length > 0) throw new Error("other values from tick 0 on need a server");
    const { file, time } = this;
    file.heard = undefined;
    file.reset();
    this.history += 1;
    file.heard = this.hear;
    this.track = new Track();
    this.track.follow(file);
    this.origin = undefined;
    this.changes.forget();
    this.edition += 1;
    time.slow();
    time.endsAt = this.fixed.samples ?? Number.POSITIVE_INFINITY;
    this.say(YOU, "reset", "reset to tick 0", { tick: 0, now: this.last });
    for (const entry of file.document.log) this.add(entry);
    if (before) {
      time.isRunning = true;
      this.say("scenario", "fast_forward", time.skip(before));
    } else this.lead();
  }

  private lead(): void {
    const words = this.time.lead();
    if (words) this.say("scenario", "fast_forward", words);
  }

  private readonly hear = (entry: FileEntry): void => {
    if (entry.kind === "tripped") this.time.isRunning = false;
    if (entry.command) this.edition += 1;
    this.add(entry);
  };

  private say(
    actor: string,
    kind: string,
    text: string,
    {
      command,
      old,
      now,
      tick = this.file.tick,
    }: { command?: unknown; old?: unknown; now?: unknown; tick?: number } = {},
  ): void {
    this.add({ tick, actor, kind, text, old, new: now, command: command as FileCommand });
  }

  private add({ command, old = null, new: now = null, ...entry }: Omit<FileEntry, "seq">): void {
    this.last += 1;
    const event = { ...entry, seq: this.last, command: command ?? null, old, new: now, at: new Date().toISOString() };
    this.events = [...this.events.slice(-KEPT), event as unknown as LogEntry];
  }

  /** Take over the events of another bench. */
  takeOver(of: LiveBench): void {
    this.events = of.events;
    this.last = of.last;
    this.takenOver = of.last;
  }

  get lastEvent(): number {
    return this.last;
  }

  /** The bench in full. */
  describe(): Bench {
    const { dt_ms, history } = this.file.document;
    const { id, name } = this;
    const own = {
      id,
      name,
      created: this.created,
      dt_ms,
      history_ticks: history.capacity,
      parameters: this.parameters,
    };
    return { ...this.fixed, ...this.status(), ...own } as unknown as Bench;
  }

  /** Its changing part. */
  status(): Omit<Status, "type" | "parameters" | "dropped_frames"> {
    const { file, time, fixed } = this;
    const slots = file.driving;
    return {
      ...statusOf(fixed),
      state: file.trip ? "tripped" : time.isRunning ? "running" : "paused",
      tick: file.tick,
      first_tick: file.oldest,
      time_scale: time.scale,
      achieved_scale: time.achieved,
      fast_forward: time.reason,
      controller: Object.values(slots).at(-1) ?? fixed.controller,
      slots,
      faults: [...file.faults].map(([fault, { severity, variant, since }]) => {
        const { profile, parameters } = file.document.faults[fault].variants[variant].parameters;
        return { name: fault, severity, profile, parameters, since_tick: since };
      }) as unknown as Status["faults"],
      pending: file.waiting.map((event) => this.pending(event)),
      undo: this.changes.last,
      redo: this.changes.next,
      trip: (file.trip ?? null) as Status["trip"],
      scores: scoresOf(file),
      last_event: this.last,
      earliest_tick: this.track.first,
      origin: this.origin ? { ...this.origin, is_past: this.isPast } : null,
      watchers: 1,
    };
  }

  private pending({ tick, when, command, actor = "scenario" }: FileEvent): Status["pending"][number] {
    const { signals, reserved } = this.file.document;
    const text = when ? `${signals[when[0] - reserved].name} ${when[1] > 0 ? ">" : "<"} ${when[2]}` : null;
    return { text: commandWords(command), actor, tick, when: text, command: { ...command } };
  }

  /** The scenario's document with all that was set since. */
  get parameters(): Bench["parameters"] {
    const document = structuredClone(this.fixed.parameters);
    const slots = Object.entries(this.file.driving);
    for (const [i, [slot, name]] of slots.entries())
      if (this.fixed.slots[slot] !== name)
        put(document, i === slots.length - 1 ? "controller.kind" : `slots.${slot}`, name);
    for (const [path, value] of Object.entries(this.file.values))
      if (this.file.document.values[path].value !== value) put(document, path, value);
    return document;
  }
}

/** The part of a description that changes. */
function statusOf({ supervisor, instrument, recording, armed, travel, company, ...rest }: Bench) {
  const { capped, overruns, given_up_ms, is_stuck, loop_lag_ms, wake_late_ms } = rest;
  const load = { capped, overruns, given_up_ms, is_stuck, loop_lag_ms, wake_late_ms };
  return { supervisor, instrument, recording, armed, travel, company, ...load };
}

function put(document: Record<string, unknown>, path: string, value: unknown): void {
  const parts = path.split(".");
  const name = parts.pop() ?? "";
  let table = document;
  for (const part of parts) {
    table[part] ??= {};
    table = table[part] as Record<string, unknown>;
  }
  table[name] = value;
}
