import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Frame } from "./decode-frame";
import { Feeds } from "./feeds";
import type { PanelFrame } from "./panel-frame";
import type { ClientMessage, Subscription } from "./wire";

const roll: Subscription = { mode: "roll", signals: ["a"], window_ms: 4, width: 100 };

const picture = (panel: number, revision: number): PanelFrame => ({
  panel,
  revision,
  signals: 1,
  columns: 1,
  startTick: 0,
  endTick: 1,
  triggerTick: Number.NaN,
  triggered: false,
  waiting: false,
  frozen: false,
  dtMs: 0.02,
  data: new Float32Array(2),
  latest: new Float32Array(1),
});

const frame = (number: number, ...panels: PanelFrame[]): Frame => ({
  running: true,
  frame: number,
  headTick: 1,
  dtMs: 0.02,
  panels,
});

describe("Feeds", () => {
  let sent: ClientMessage[];
  let feeds: Feeds;

  beforeEach(() => {
    sent = [];
    feeds = new Feeds((message) => sent.push(message));
  });

  it("tells a panel, and no other, which captures its trigger has", () => {
    const [hear, other] = [vi.fn(), vi.fn()];
    const feed = feeds.open(roll, vi.fn(), 0, hear);
    feeds.open(roll, vi.fn(), 0, other);
    const list = { type: "captures", panel: feed.panel, captures: [], most: 50, is_short: false } as const;
    feeds.captured({ ...list, captures: [] });
    expect(hear).toHaveBeenCalledExactlyOnceWith(list);
    expect(other).not.toHaveBeenCalled();
    feeds.captured({ ...list, captures: [], panel: 999 });
    expect(hear).toHaveBeenCalledTimes(1);
  });

  it("draws the newest picture once and acknowledges after drawing", () => {
    const draw = vi.fn(() => expect(sent.some((m) => m.type === "ack")).toBe(false));
    const feed = feeds.open(roll, draw);
    feeds.receive(frame(1, picture(feed.panel, 1)));
    const newest = picture(feed.panel, 1);
    feeds.receive(frame(2, newest));
    expect(draw).not.toHaveBeenCalled();
    expect(feeds.draw()).toBe(1);
    expect(draw).toHaveBeenCalledExactlyOnceWith(newest);
    expect(sent.at(-1)).toEqual({ type: "ack", frame: 2 });
    expect(feeds.draw()).toBe(0);
    expect(sent.filter((m) => m.type === "ack")).toHaveLength(1);
  });

  it("draws what cannot be read faster only now and then, but the newest in the end", () => {
    const now = vi.spyOn(performance, "now").mockReturnValue(1000);
    const draw = vi.fn();
    const feed = feeds.open(roll, draw, 100);
    const [first, skipped, last] = [1, 2, 3].map(() => picture(feed.panel, 1));
    feeds.receive(frame(1, first));
    expect(feeds.draw()).toBe(1);
    now.mockReturnValue(1050);
    feeds.receive(frame(2, skipped));
    feeds.receive(frame(3, last));
    expect(feeds.draw()).toBe(0);
    expect(sent.at(-1)).toEqual({ type: "ack", frame: 3 });
    now.mockReturnValue(1100);
    expect(feeds.draw()).toBe(1);
    expect(draw.mock.calls).toEqual([[first], [last]]);
    now.mockRestore();
  });

  it("draws the newest picture again on a new plot, unless it is one of other signals", () => {
    const draw = vi.fn();
    const feed = feeds.open(roll, draw);
    const newest = picture(feed.panel, 1);
    feed.redraw();
    expect(feeds.draw()).toBe(0);
    feeds.receive(frame(1, newest));
    feeds.draw();
    feed.redraw();
    feeds.draw();
    expect(draw.mock.calls).toEqual([[newest], [newest]]);
    feeds.change(feed, { ...roll, window_ms: 8 });
    feed.redraw();
    expect(feeds.draw()).toBe(1);
    feeds.change(feed, { ...roll, signals: ["b"] });
    feed.redraw();
    expect(feeds.draw()).toBe(0);
  });

  it("ignores a picture that answers an older subscription, but still acknowledges it", () => {
    const draw = vi.fn();
    const feed = feeds.open(roll, draw);
    feeds.change(feed, { ...roll, window_ms: 8 });
    feeds.receive(frame(1, picture(feed.panel, 1)));
    feeds.draw();
    expect(draw).not.toHaveBeenCalled();
    expect(sent.at(-1)).toEqual({ type: "ack", frame: 1 });
    feeds.receive(frame(2, picture(feed.panel, 2)));
    feeds.draw();
    expect(draw).toHaveBeenCalledOnce();
  });

  it("subscribes again from revision 1 and frame 1 after a reconnect", () => {
    const draw = vi.fn();
    const feed = feeds.open(roll, draw);
    feeds.change(feed, roll);
    feeds.receive(frame(40, picture(feed.panel, 2)));
    feeds.draw();
    sent.length = 0;
    feeds.reconnected();
    expect(sent).toEqual([{ type: "subscribe", panel: feed.panel, ...roll }]);
    feeds.receive(frame(1, picture(feed.panel, 1)));
    feeds.draw();
    expect(draw).toHaveBeenCalledTimes(2);
    expect(sent.at(-1)).toEqual({ type: "ack", frame: 1 });
  });

  it("never reuses the number of a panel that is open", () => {
    const first = feeds.open(roll, vi.fn());
    const second = feeds.open(roll, vi.fn());
    feeds.close(first);
    expect(feeds.open(roll, vi.fn()).panel).not.toBe(second.panel);
    expect(feeds.size).toBe(2);
  });

  it("still draws after a refused subscription that the server has not counted", () => {
    const draw = vi.fn();
    const feed = feeds.open(roll, draw);
    feeds.change(feed, roll);
    feeds.refused();
    feeds.receive(frame(1, picture(feed.panel, 1)));
    feeds.draw();
    expect(draw).toHaveBeenCalledOnce();
  });

  it("acknowledges unseen what is drawn when somebody looks again", () => {
    const draw = vi.fn();
    const feed = feeds.open(roll, draw);
    feeds.receive(frame(1, picture(feed.panel, 1)));
    feeds.acknowledge();
    feeds.acknowledge();
    expect(sent.filter((m) => m.type === "ack")).toEqual([{ type: "ack", frame: 1 }]);
    expect(draw).not.toHaveBeenCalled();
    feeds.draw();
    expect(draw).toHaveBeenCalledOnce();
    expect(sent.filter((m) => m.type === "ack")).toHaveLength(1);
  });

  it("goes on when one panel cannot draw", () => {
    const error = vi.spyOn(console, "error").mockImplementation(() => undefined);
    const bad = feeds.open(roll, () => {
      throw new Error("broken");
    });
    const draw = vi.fn();
    const good = feeds.open(roll, draw);
    feeds.receive(frame(1, picture(bad.panel, 1), picture(good.panel, 1)));
    feeds.draw();
    expect(draw).toHaveBeenCalledOnce();
    expect(sent.at(-1)).toEqual({ type: "ack", frame: 1 });
    error.mockRestore();
  });
});
