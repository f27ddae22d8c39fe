import type { PanelFrame } from "./panel-frame";
import { type CaptureList, type Subscription, tracesOf } from "./wire";

const tracesIn = ({ signals, behind }: Subscription): string => JSON.stringify([signals, behind]);

/** The subscription of one visible panel, and its newest picture. */
export class Feed {
  readonly panel: number;
  readonly draw: (frame: PanelFrame) => void;
  subscription: Subscription;
  /** How often this panel has subscribed on this connection; older pictures are ignored. */
  revision = 0;
  frame: PanelFrame | undefined;
  dirty = false;
  /** Least time between two drawings, ms: figures that change faster cannot be read. */
  readonly everyMs: number;
  /** When it may be drawn again. */
  due = 0;
  /** The server refused something, so its count of our subscriptions may lag behind ours. */
  uncertain = false;
  /** Hears which captures its trigger has. */
  readonly hear: (captures: CaptureList) => void;

  constructor(
    panel: number,
    subscription: Subscription,
    draw: (frame: PanelFrame) => void,
    everyMs: number,
    hear: (captures: CaptureList) => void,
  ) {
    this.panel = panel;
    this.subscription = subscription;
    this.draw = draw;
    this.everyMs = everyMs;
    this.hear = hear;
  }

  /** Take a picture from the wire, unless it answers an older subscription. */
  store(frame: PanelFrame): void {
    if (this.uncertain ? !this.fits(frame) : frame.revision !== this.revision) return;
    this.frame = frame;
    this.dirty = true;
  }

  /** Ask for another subscription; the picture of other signals says nothing about these. */
  ask(subscription: Subscription): void {
    if (tracesIn(subscription) !== tracesIn(this.subscription)) this.frame = undefined;
    this.subscription = subscription;
  }

  /** Draw the newest picture again: the panel has a new plot, and a paused bench sends no new picture. */
  redraw(): void {
    this.dirty = true;
    this.due = 0;
  }

  private fits(frame: PanelFrame): boolean {
    return frame.signals === tracesOf(this.subscription) && frame.frozen === (this.subscription.mode === "frozen");
  }
}
