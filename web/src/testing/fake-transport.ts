import { act } from "@testing-library/react";
import { expect, vi } from "vitest";
import type { ApiErrorBody, Bench, Command, LogEntry } from "../api/types";
import { useBench } from "../stream/bench-store";
import { createStream } from "../stream/create-stream";
import { setStream, stream } from "../stream/stream";
import type { Channel, ChannelEvents } from "../stream/transport";
import type { ClientMessage, ServerMessage, Status, Subscription } from "../stream/wire";
import { encodeFrame } from "./encode-frame";
import { type FrameTime, pictureOf, type Values } from "./frame-picture";
import type { RecordedFrame } from "./recorded";

const LOST = 1006;

type Sent<T extends ClientMessage["type"]> = Extract<ClientMessage, { type: T }>;

/** The present subscription of a panel. */
interface Subscribed {
  panel: number;
  /** How often the panel has subscribed on this channel. */
  revision: number;
  subscription: Subscription;
}

/** The board at the other end of the page's stream: a test sends its messages and reads the messages of the page. */
export class FakeTransport {
  /** Every message of the page, the oldest first. */
  sent: ClientMessage[] = [];
  /** Subscriptions on this channel, by panel. */
  private readonly panels = new Map<number, Subscribed>();
  private channel: (Channel & { events: ChannelEvents; isOpen: boolean }) | undefined;
  private answered = 0;
  private frames = 0;
  private headTick = 0;

  constructor() {
    const made = () => createStream((_, events) => this.open(events));
    setStream(vi.isFakeTimers() ? made() : withoutWatch(made));
  }

  /** Whether the channel is open. */
  get isOpen(): boolean {
    return this.channel?.isOpen ?? false;
  }

  /** The commands of the page, the oldest first. */
  get commands(): Command[] {
    return this.of("command").map(({ command }) => command);
  }

  /** Subscriptions of the visible panels. */
  get subscriptions(): Subscription[] {
    return [...this.panels.values()].map(({ subscription }) => subscription);
  }

  /** Messages of one type. */
  of<T extends ClientMessage["type"]>(type: T): Sent<T>[] {
    return this.sent.filter((message): message is Sent<T> => message.type === type);
  }

  /** Let the channel open. */
  accept(): void {
    const { channel } = this;
    if (!channel) throw new Error("the page has opened no channel");
    channel.isOpen = true;
    act(() => channel.events.onOpen());
  }

  /** Send any message. */
  say(message: ServerMessage): void {
    this.deliver(JSON.stringify(message));
  }

  /** Say which bench this is; a channel that is not open yet opens. */
  hello(bench: Bench, rest: { server?: string; last_event?: number } = {}): void {
    if (!this.isOpen) this.accept();
    this.say({ type: "hello", wire: 2, server: "server", last_event: 0, bench, ...rest } as ServerMessage);
  }

  /** Send changes of the bench. */
  status(changes: Partial<Status>): void {
    this.say({ type: "status", ...changes } as Status);
  }

  /** Send events, and wait until they are listed. */
  async events(events: LogEntry[]): Promise<void> {
    this.say({ type: "events", events } as ServerMessage);
    const { seq } = events[events.length - 1];
    await act(() => vi.waitFor(() => expect(useBench.getState().events.some((event) => event.seq === seq)).toBe(true)));
  }

  /**
   * Send each panel that subscribes to some of these signals its picture, of values by tick; the test draws it with
   * `drawOnce`. Signals without values have none.
   *
   * @example board.frame({ "plant.displacement": (tick) => Math.sin(tick / 10) }, { head: 400 })
   */
  frame(values: Values, time: FrameTime): void {
    this.headTick = time.head;
    const dtMs = useBench.getState().bench?.dt_ms ?? 1;
    const wanted = [...this.panels.values()].filter(({ subscription }) =>
      subscription.signals.some((s) => s in values),
    );
    if (wanted.length === 0) throw new Error(`no panel subscribes to any of ${Object.keys(values).join(", ")}`);
    const panels = wanted.map((one) => ({ ...one, ...pictureOf(one.subscription, values, time, dtMs) }));
    this.frames += 1;
    const bytes = encodeFrame({ frame: this.frames, headTick: time.head, dtMs, panels });
    this.deliver(bytes);
  }

  /** Send a frame that was recorded to the panel that subscribes to its signals. */
  replay({ signals, bytes }: RecordedFrame): void {
    const wanted = [...this.panels.values()].find((one) => `${one.subscription.signals}` === `${signals}`);
    if (!wanted) throw new Error(`no panel subscribes to ${signals.join(", ")}`);
    const buffer = Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0)).buffer;
    const view = new DataView(buffer);
    this.frames += 1;
    view.setUint32(4, this.frames, true);
    view.setUint16(32, wanted.panel, true);
    view.setFloat64(64, wanted.revision, true);
    this.deliver(buffer);
  }

  /** Answer the oldest command without an answer: it took effect at a tick. */
  reply(tick = this.headTick): Promise<void> {
    return this.answer({ ok: true, tick, error: null });
  }

  /** Refuse the oldest command without an answer, in words. */
  refuse(message: string, rest: Partial<ApiErrorBody> = {}): Promise<void> {
    return this.answer({ ok: false, tick: null, error: { code: "refused", message, field: "", hint: "", ...rest } });
  }

  /** Close the channel with a code, as a server that goes or a network that fails. */
  drop(code = LOST): Promise<void> {
    return act(async () => {
      if (this.channel) this.channel.isOpen = false;
      this.channel?.events.onClose(code);
    });
  }

  private deliver(data: string | ArrayBuffer): void {
    if (!this.channel?.isOpen) throw new Error("the channel to the page is not open");
    const { events } = this.channel;
    act(() => events.onMessage(data));
  }

  private answer(how: { ok: boolean; tick: number | null; error: ApiErrorBody | null }): Promise<void> {
    const command = this.of("command")[this.answered];
    if (!command) throw new Error("the page waits for no answer");
    this.answered += 1;
    return act(async () => this.say({ type: "reply", id: command.id, ...how } as ServerMessage));
  }

  private open(events: ChannelEvents): Channel {
    this.panels.clear();
    const channel = {
      events,
      isOpen: false,
      send: (text: string) => this.hear(JSON.parse(text) as ClientMessage),
      close: () => {
        channel.isOpen = false;
      },
    };
    this.channel = channel;
    return channel;
  }

  private hear(message: ClientMessage): void {
    this.sent.push(message);
    if (message.type === "unsubscribe") this.panels.delete(message.panel);
    if (message.type !== "subscribe") return;
    const { type: _, panel, ...subscription } = message;
    const revision = (this.panels.get(panel)?.revision ?? 0) + 1;
    this.panels.set(panel, { panel, revision, subscription });
  }
}

/** Show a bench on the page, connected: the board at the other end. */
export function connect(bench: Bench): FakeTransport {
  const board = new FakeTransport();
  stream.open(bench.id);
  board.hello(bench);
  return board;
}

/** A stream checks on a timer whether the server is silent. Only a test with a clock of its own lets this timer run. */
function withoutWatch<T>(make: () => T): T {
  const timer = vi.spyOn(globalThis, "setInterval").mockReturnValue(0 as never);
  try {
    return make();
  } finally {
    timer.mockRestore();
  }
}
