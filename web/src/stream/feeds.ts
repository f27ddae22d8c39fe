import type { Frame } from "./decode-frame";
import { Feed } from "./feed";
import type { PanelFrame } from "./panel-frame";
import type { CaptureList, ClientMessage, Subscription } from "./wire";

const PANEL_IDS = 65535;

/**
 * The visible panels with their subscriptions and the frames they have drawn.
 *
 * `receive` only stores; `draw` paints new frames and acknowledges them, so the server never runs ahead.
 */
export class Feeds {
  private readonly feeds = new Map<number, Feed>();
  private readonly send: (message: ClientMessage) => void;
  private nextPanel = 1;
  private received = 0;
  private acknowledged = 0;

  constructor(send: (message: ClientMessage) => void) {
    this.send = send;
  }

  get size(): number {
    return this.feeds.size;
  }

  open(
    subscription: Subscription,
    draw: (frame: PanelFrame) => void,
    everyMs = 0,
    hear: (captures: CaptureList) => void = () => undefined,
  ): Feed {
    while (this.feeds.has(this.nextPanel)) this.nextPanel = (this.nextPanel % PANEL_IDS) + 1;
    const feed = new Feed(this.nextPanel, subscription, draw, everyMs, hear);
    this.nextPanel = (this.nextPanel % PANEL_IDS) + 1;
    this.feeds.set(feed.panel, feed);
    this.subscribe(feed);
    return feed;
  }

  change(feed: Feed, subscription: Subscription): void {
    feed.ask(subscription);
    this.subscribe(feed);
  }

  close(feed: Feed): void {
    if (this.feeds.delete(feed.panel)) this.send({ type: "unsubscribe", panel: feed.panel });
  }

  rearm(feed: Feed): void {
    this.send({ type: "rearm", panel: feed.panel });
  }

  /** A new connection knows nothing: count subscriptions and frames from the start again. */
  reconnected(): void {
    this.received = 0;
    this.acknowledged = 0;
    for (const feed of this.feeds.values()) {
      feed.revision = 0;
      feed.uncertain = false;
      this.subscribe(feed);
    }
  }

  /** A message was refused; it may have been a subscription, which the server then has not counted. */
  refused(): void {
    for (const feed of this.feeds.values()) feed.uncertain = true;
  }

  receive(frame: Frame): void {
    this.received = Math.max(this.received, frame.frame);
    for (const picture of frame.panels) this.feeds.get(picture.panel)?.store(picture);
  }

  captured(captures: CaptureList): void {
    this.feeds.get(captures.panel)?.hear(captures);
  }

  /** Draw the feeds that are new and due, and acknowledge the arrived frames. Returns how many panels were drawn. */
  draw(): number {
    let drawn = 0;
    const now = performance.now();
    for (const feed of this.feeds.values()) {
      if (!feed.dirty || !feed.frame || now < feed.due) continue;
      feed.dirty = false;
      feed.due = now + feed.everyMs;
      drawn += 1;
      try {
        feed.draw(feed.frame);
      } catch (error) {
        console.error("panel could not draw", error);
      }
    }
    this.acknowledge();
    return drawn;
  }

  /** Draw every picture again: the marks in it have changed, and a paused bench sends no new picture. */
  redraw(): void {
    for (const feed of this.feeds.values()) feed.redraw();
  }

  /** Acknowledge the arrived frames without drawing them: the page is hidden, and keeps the newest for later. */
  acknowledge(): void {
    if (this.received <= this.acknowledged) return;
    this.acknowledged = this.received;
    this.send({ type: "ack", frame: this.received });
  }

  private subscribe(feed: Feed): void {
    feed.revision += 1;
    this.send({ type: "subscribe", panel: feed.panel, ...feed.subscription });
  }
}
