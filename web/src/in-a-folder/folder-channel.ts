import type { components } from "../api/schema";
import type { FileBench } from "../in-a-file/file-bench";
import { encodeFrame } from "../stream/encode-frame";
import type { PanelFrame } from "../stream/panel-frame";
import { type ClientMessage, type Subscription, WIRE_VERSION } from "../stream/wire";
import type { LiveBench } from "./live-bench";
import { Sweep, type Swept } from "./sweep";
import { spanBetween, spanEnding, spanFrom, type TickSpan } from "./tick-span";

/** Most frames that are sent and not acknowledged yet. */
const WINDOW = 2;
const STATUS_MS = 200;
const EVENTS_AT_ONCE = 100;
/** Most statuses that the page has not taken yet: beyond, nothing is sent but answers. */
const STATUSES = 4;

type Find = (bench: string) => LiveBench | undefined;

interface Panel {
  subscription: Subscription;
  signals: number[];
  behind: readonly { bench: string; shift_ticks: number }[];
  sweep: Sweep | undefined;
  revision: number;
  /** Differs for each picture. */
  sent: string;
}

/** One stream from a bench to a page, in the words of the server. */
export class FolderChannel {
  readonly bench: LiveBench;
  private readonly find: Find;
  private readonly post: (data: string | ArrayBuffer) => void;
  private readonly panels = new Map<number, Panel>();
  private readonly revisions = new Map<number, number>();
  private statuses = 0;
  private taken = 0;
  private frame = 0;
  private acked = 0;
  private cursor: number;
  private edition = 0;
  private told = Number.NEGATIVE_INFINITY;

  constructor(bench: LiveBench, server: string, find: Find, post: (data: string | ArrayBuffer) => void) {
    this.bench = bench;
    this.find = find;
    this.post = post;
    this.cursor = bench.lastEvent;
    this.say({ type: "hello", wire: WIRE_VERSION, server, bench: bench.describe(), last_event: bench.lastEvent });
  }

  /** Hear a message of the page. */
  hear(message: ClientMessage): void {
    if (message.type === "subscribe") this.subscribe(message);
    else if (message.type === "unsubscribe") this.panels.delete(message.panel);
    else if (message.type === "ack") this.acked = Math.max(this.acked, Math.min(message.frame, this.frame));
    else if (message.type === "rearm") this.rearm(message.panel);
    else if (message.type === "took") this.taken = Math.max(this.taken, Math.min(message.statuses, this.statuses));
    else if (message.type === "resume") this.cursor = Math.min(message.after, this.bench.lastEvent);
    else if (message.type === "command") this.command(message);
  }

  /** Send new events, the status, and a picture if the page takes it. A page that lags gets the newest later. */
  flush(now: number): void {
    if (this.statuses - this.taken >= STATUSES) return;
    if (this.events() || now - this.told >= STATUS_MS) {
      this.told = now;
      this.status();
    }
    if (this.frame - this.acked < WINDOW) this.picture();
  }

  private subscribe({ type: _, panel, ...subscription }: Extract<ClientMessage, { type: "subscribe" }>): void {
    const names = this.bench.file.signals.map(({ name }) => name);
    const signals = subscription.signals.map((name) => names.indexOf(name));
    const { behind = [] } = subscription;
    const sweep = this.sweepOf(subscription);
    const trigger = subscription.mode === "triggered" ? subscription.trigger : undefined;
    const unknown = subscription.signals[signals.indexOf(-1)];
    const gone = behind.findIndex(({ bench }) => !this.find(bench));
    if (unknown !== undefined) this.refuse(`there is no signal ${unknown}`, "signals");
    else if (sweep === null) this.refuse(`there is no signal ${trigger?.signal}`, "trigger.signal");
    else if (gone >= 0) this.refuse(`there is no bench ${behind[gone].bench}`, `behind.${gone}`);
    else {
      const revision = (this.revisions.get(panel) ?? 0) + 1;
      this.revisions.set(panel, revision);
      this.panels.set(panel, { subscription, signals, behind, sweep: sweep ?? undefined, revision, sent: "" });
    }
  }

  /** The sweep of a triggered panel; none for a panel of another mode, null where the signal is not there. */
  private sweepOf(subscription: Subscription): Sweep | undefined | null {
    if (subscription.mode !== "triggered") return undefined;
    const { file } = this.bench;
    const signal = file.signals.findIndex(({ name }) => name === subscription.trigger.signal);
    return signal < 0 ? null : new Sweep(file, signal, subscription.trigger, windowOf(file, subscription.window_ms));
  }

  private rearm(panel: number): void {
    const shown = this.panels.get(panel);
    if (shown) shown.sweep?.rearm();
    else this.refuse(`panel ${panel} is not subscribed`, "panel");
  }

  private refuse(message: string, field: string): void {
    this.say({ type: "error", error: { code: "invalid", message, field, hint: "" } });
  }

  private command({ id, command }: Extract<ClientMessage, { type: "command" }>): void {
    try {
      this.bench.execute(command);
    } catch (error) {
      this.say({ type: "reply", id, ok: false, error: refusalOf(error as Error) });
      return;
    }
    const tick = this.bench.events.at(-1)?.tick; // of a step the tick at which it began
    this.events();
    this.status();
    this.say({ type: "reply", id, ok: true, tick });
  }

  /** Send the events that are new; whether there are any. */
  private events(): boolean {
    const { events, lastEvent } = this.bench;
    const isNew = lastEvent > this.cursor;
    while (this.cursor < lastEvent) {
      const after = events.filter(({ seq }) => seq > this.cursor).slice(0, EVENTS_AT_ONCE);
      this.say({ type: "events", events: after });
      this.cursor = after.at(-1)?.seq ?? lastEvent;
    }
    return isNew;
  }

  private status(): void {
    const { bench } = this;
    const parameters = bench.edition === this.edition ? null : bench.parameters;
    this.edition = bench.edition;
    this.statuses += 1;
    this.say({ type: "status", ...bench.status(), parameters, dropped_frames: 0 });
  }

  private picture(): void {
    const { file, time } = this.bench;
    const panels: PanelFrame[] = [];
    for (const [number, panel] of this.panels) {
      const shown = pictureOf(this.bench, panel, this.find);
      if (shown.key === panel.sent) continue;
      panel.sent = shown.key;
      panels.push({ ...shown.draw(), panel: number, revision: panel.revision });
    }
    if (panels.length === 0) return;
    this.frame += 1;
    const moment = { headTick: file.tick, dtMs: file.document.dt_ms };
    this.post(encodeFrame({ frame: this.frame, running: time.isRunning, ...moment, panels }));
  }

  private say(message: components["schemas"]["Hello"] | object): void {
    this.post(JSON.stringify(message));
  }
}

/** A refusal in the shape of the server. */
export const refusalOf = ({ message }: Error) => ({ code: "refused", message, field: "", hint: "" });

/** The columns of a panel now, and the crossing in them. */
function spanOf(file: FileBench, { subscription, sweep }: Panel, swept: Swept | undefined): TickSpan {
  const { width } = subscription;
  if (subscription.mode === "frozen") return spanBetween(subscription.start_tick, subscription.end_tick, width);
  const window = windowOf(file, subscription.window_ms);
  if (!sweep || !swept) return spanEnding(file.tick, window, width);
  if (swept.tick !== undefined) return spanFrom(swept.tick - sweep.before, window, width);
  const rolling = spanEnding(file.tick, window, width);
  if (sweep.isAuto) return rolling;
  return { ...rolling, start: file.tick, end: file.tick + rolling.end - rolling.start }; // behind the newest tick
}

/** The picture of a panel now: pictures differ if their keys do. */
function pictureOf({ file, history }: LiveBench, panel: Panel, find: Find) {
  const { subscription, signals, behind, sweep } = panel;
  const isFrozen = subscription.mode === "frozen";
  const swept = sweep?.update();
  const { start, end, columns } = spanOf(file, panel, swept);
  const others = behind.map(({ bench, shift_ticks }) => ({ file: find(bench)?.file, shift: shift_ticks }));
  const cuts = () => [
    file.cut(signals, start, end, columns),
    ...others.map(
      (one) =>
        one.file?.cut(signals, start + one.shift, end + one.shift, columns) ??
        new Float32Array(2 * signals.length * columns).fill(Number.NaN),
    ),
  ];
  const nothing = new Float32Array(signals.length * others.length).fill(Number.NaN);
  const draw = (): Omit<PanelFrame, "panel" | "revision"> => ({
    signals: signals.length * (1 + others.length),
    columns,
    startTick: start,
    endTick: end,
    triggerTick: swept?.tick === undefined ? Number.NaN : (sweep?.exact(swept.tick) ?? Number.NaN),
    triggered: swept?.triggered ?? false,
    waiting: swept?.waiting ?? false,
    frozen: isFrozen,
    dtMs: file.document.dt_ms,
    data: joined(cuts()),
    latest: joined([latestOf(file, signals), nothing]),
  });
  const isEmpty = swept?.tick === undefined && sweep?.isAuto === false;
  const head = isFrozen ? Math.min(Math.max(file.tick, start), end) : (swept?.tick ?? (isEmpty ? 0 : file.tick));
  const behindKey = others.map((one) => `${one.file?.tick} ${one.file?.oldest}`);
  const flags = swept && `${swept.tick !== undefined} ${swept.waiting} ${swept.triggered}`;
  return { key: [history, head, flags, file.oldest, ...behindKey].join(), draw };
}

function joined(parts: readonly Float32Array[]): Float32Array {
  const whole = new Float32Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

const windowOf = (file: FileBench, ms: number): number => Math.max(2, Math.round(ms / file.document.dt_ms));

/** The newest sample of each signal that the history has. */
function latestOf(file: FileBench, signals: readonly number[]): Float32Array {
  if (file.tick <= file.oldest) return new Float32Array(signals.length).fill(Number.NaN);
  return file.cut(signals, file.tick - 1, file.tick, 1).filter((_, i) => i % 2 === 0);
}
