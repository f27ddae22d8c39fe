import { ApiError } from "../api/client";
import type { components } from "../api/schema";
import type { Command } from "../api/types";
import { type CloseReason, closeReason } from "./close-reason";
import { decodeFrame, type Frame } from "./decode-frame";
import { Feeds } from "./feeds";
import type { Channel, Transport } from "./transport";
import type { ClientMessage, ServerMessage } from "./wire";

const REPLY_TIMEOUT_MS = 5000;
/** A channel that does not open within this time counts as lost: a network may swallow the attempt without a word. */
const OPEN_TIMEOUT_MS = 10_000;
/** The reason of a lost connection is not waited for longer than this. */
const EXPLAIN_TIMEOUT_MS = 3000;
const LOST = 1006;

export interface StreamHandlers {
  onMessage(message: ServerMessage): void;
  onOpen(): void;
  /** Whether what arrives is drawn soon; drawing acknowledges it. */
  isDrawing(): boolean;
  /** `retryAt` is the time of the next attempt on `performance.now()`'s clock, if there will be one. */
  onClose(reason: CloseReason, code: number, retryAt: number | undefined): void;
  /** Asked when a connection never opened: why, if the server can be asked. */
  explain(): Promise<number | undefined>;
}

interface Head {
  tick: number;
  dtMs: number;
  running: boolean;
}

interface Pending {
  resolve(tick: number): void;
  reject(error: ApiError): void;
  timer: ReturnType<typeof setTimeout>;
}

/** One page's connection to one bench: keeps itself alive, stores messages, sends commands and subscriptions. */
export class StreamClient {
  readonly feeds = new Feeds((message) => this.send(message));
  head: Head = { tick: 0, dtMs: 0, running: false };
  /** When anything last arrived from the bench shown, on `performance.now()`'s clock. */
  lastHeard = performance.now();
  private readonly handlers: StreamHandlers;
  private readonly replies = new Map<string, Pending>();
  private readonly transport: Transport;
  private channel: Channel | undefined;
  private bench = "";
  private attempt = 0;
  private nextId = 1;
  /** Statuses of the present channel: a page that is stopped takes none, and the server then sends no more. */
  private statuses = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(handlers: StreamHandlers, transport: Transport) {
    this.handlers = handlers;
    this.transport = transport;
  }

  get isOpen(): boolean {
    return this.channel?.isOpen ?? false;
  }

  connect(bench: string): void {
    this.disconnect();
    this.bench = bench;
    this.attempt = 0;
    this.lastHeard = performance.now();
    this.open();
  }

  disconnect(): void {
    this.abandon();
    this.failReplies("The page left this bench.");
  }

  /** Open another channel at once, unless the present one is open. */
  retryNow(): void {
    if (this.isOpen || !this.bench) return;
    this.abandon();
    this.open();
  }

  send(message: ClientMessage): void {
    if (this.isOpen) this.channel?.send(JSON.stringify(message));
  }

  /** Send a command; resolves with the tick at which it took effect. */
  command(command: Command): Promise<number> {
    if (!this.isOpen) return Promise.reject(this.failure("The bench is not connected; nothing was sent."));
    const id = `c${this.nextId++}`;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => {
        this.replies.delete(id);
        reject(this.failure("The server did not answer in time."));
      }, REPLY_TIMEOUT_MS);
      this.replies.set(id, { resolve, reject, timer });
      this.send({ type: "command", id, command });
    });
  }

  private abandon(): void {
    clearTimeout(this.timer);
    const old = this.channel;
    this.channel = undefined;
    old?.close();
  }

  private open(): void {
    let opened = false;
    const channel = this.transport(this.bench, {
      onOpen: () => {
        clearTimeout(this.timer);
        opened = true;
        this.statuses = 0;
        this.handlers.onOpen();
        this.feeds.reconnected();
      },
      onMessage: (data) => this.receive(data),
      onClose: async (code) => {
        if (this.channel !== channel) return;
        clearTimeout(this.timer);
        this.failReplies("The connection was lost before the answer came.");
        const known = opened ? code : ((await this.explained()) ?? code);
        if (this.channel !== channel) return;
        this.channel = undefined;
        this.closed(known);
      },
    });
    this.channel = channel;
    this.timer = setTimeout(() => {
      this.abandon();
      this.closed(LOST);
    }, OPEN_TIMEOUT_MS);
  }

  /** Why a channel never opened, if the server says so in time. */
  private explained(): Promise<number | undefined> {
    const late = new Promise<undefined>((resolve) => setTimeout(resolve, EXPLAIN_TIMEOUT_MS));
    return Promise.race([this.handlers.explain().catch(() => undefined), late]);
  }

  private closed(code: number): void {
    const reason = closeReason(code);
    if (!reason.retry) {
      this.handlers.onClose(reason, code, undefined);
      return;
    }
    const delay = reconnectDelay(this.attempt++);
    this.timer = setTimeout(() => this.open(), delay);
    this.handlers.onClose(reason, code, performance.now() + delay);
  }

  private receive(data: ArrayBuffer | string): void {
    this.lastHeard = performance.now();
    if (typeof data === "string") this.receiveText(JSON.parse(data) as ServerMessage);
    else this.receiveFrame(decodeFrame(data));
    // At every message, not only at a frame: the server sends no frame more while two wait for a drawing that does not
    // come, as when the page was hidden just now, but its status comes all the same.
    if (!this.handlers.isDrawing()) this.feeds.acknowledge();
  }

  private receiveText(message: ServerMessage): void {
    // At once, and by no timer: a hidden page still receives and still drives.
    if (message.type === "ping") this.send({ type: "pong" });
    if (message.type === "reply") this.reply(message);
    if (message.type === "hello") this.attempt = 0;
    this.handlers.onMessage(message);
    if (message.type === "status") this.send({ type: "took", statuses: ++this.statuses });
  }

  private receiveFrame(frame: Frame): void {
    this.head = { tick: frame.headTick, dtMs: frame.dtMs, running: frame.running };
    this.feeds.receive(frame);
  }

  private reply(message: components["schemas"]["Reply"]): void {
    const pending = this.replies.get(message.id);
    if (!pending) return;
    this.replies.delete(message.id);
    clearTimeout(pending.timer);
    if (message.ok) pending.resolve(message.tick ?? 0);
    else if (message.error) pending.reject(new ApiError(422, message.error));
  }

  private failReplies(why: string): void {
    for (const pending of this.replies.values()) {
      clearTimeout(pending.timer);
      pending.reject(this.failure(why));
    }
    this.replies.clear();
  }

  private failure(message: string): ApiError {
    return new ApiError(0, { code: "offline", message, field: "", hint: "" });
  }
}

const STEPS_MS = [500, 1000, 2000, 5000];

/** How long to wait before connection attempt `attempt` (0, 1, ...): 0.5, 1, 2, then 5 s, +-20 %. */
export function reconnectDelay(attempt: number, random: () => number = Math.random): number {
  const base = STEPS_MS[Math.min(attempt, STEPS_MS.length - 1)];
  return base * (0.8 + 0.4 * random());
}
