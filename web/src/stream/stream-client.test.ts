import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { encodeFrame } from "../testing/encode-frame";
import { reconnectDelay, StreamClient, type StreamHandlers } from "./stream-client";
import type { Channel, ChannelEvents } from "./transport";

/** A channel that only remembers; the test plays the server. */
class FakeChannel implements Channel {
  static made: FakeChannel[] = [];
  isOpen = false;
  sent: string[] = [];
  private readonly events: ChannelEvents;

  constructor(_bench: string, events: ChannelEvents) {
    this.events = events;
    FakeChannel.made.push(this);
  }

  send(text: string) {
    this.sent.push(text);
  }

  close() {
    this.isOpen = false;
  }

  accept() {
    this.isOpen = true;
    this.events.onOpen();
  }

  say(message: object | ArrayBuffer) {
    this.events.onMessage(message instanceof ArrayBuffer ? message : JSON.stringify(message));
  }

  async drop(code: number) {
    this.isOpen = false;
    this.events.onClose(code);
    await vi.advanceTimersByTimeAsync(0);
  }
}

describe("StreamClient", () => {
  let handlers: { [K in keyof StreamHandlers]: ReturnType<typeof vi.fn> };
  let client: StreamClient;
  const last = () => FakeChannel.made[FakeChannel.made.length - 1];
  const types = (channel: FakeChannel) => channel.sent.map((text) => (JSON.parse(text) as { type: string }).type);

  beforeEach(() => {
    vi.useFakeTimers();
    vi.spyOn(Math, "random").mockReturnValue(0.5);
    FakeChannel.made = [];
    handlers = {
      onMessage: vi.fn(),
      onOpen: vi.fn(),
      isDrawing: vi.fn(() => true),
      onClose: vi.fn(),
      explain: vi.fn(async () => undefined),
    };
    client = new StreamClient(handlers as unknown as StreamHandlers, (bench, events) => new FakeChannel(bench, events));
    client.connect("b1");
  });

  afterEach(() => {
    vi.useRealTimers();
    vi.restoreAllMocks();
  });

  it("subscribes when it is open", () => {
    client.feeds.open({ mode: "roll", signals: ["a"], window_ms: 1, width: 10 }, vi.fn());
    expect(last().sent).toEqual([]);
    last().accept();
    expect(types(last())).toEqual(["subscribe"]);
  });

  it("answers a ping where it arrives, also while nothing is drawn", () => {
    last().accept();
    handlers.isDrawing.mockReturnValue(false);
    last().say({ type: "ping" });
    expect(types(last())).toEqual(["pong"]);
  });

  it("waits 0.5, 1, 2, 5 s between attempts, and starts over after a hello", async () => {
    last().accept();
    const waits: number[] = [];
    for (let i = 0; i < 4; i += 1) {
      await last().drop(1006);
      const before = FakeChannel.made.length;
      let waited = 0;
      while (FakeChannel.made.length === before) {
        await vi.advanceTimersByTimeAsync(100);
        waited += 100;
      }
      waits.push(waited);
    }
    expect(waits).toEqual([500, 1000, 2000, 5000]);
    last().accept();
    last().say({ type: "hello" });
    await last().drop(1001);
    await vi.advanceTimersByTimeAsync(500);
    expect(FakeChannel.made).toHaveLength(6);
  });

  it("does not try again when that cannot help", async () => {
    last().accept();
    await last().drop(4404);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(FakeChannel.made).toHaveLength(1);
    expect(handlers.onClose).toHaveBeenCalledWith(
      expect.objectContaining({ title: "This bench was closed" }),
      4404,
      undefined,
    );
  });

  it("asks why when a connection never opened", async () => {
    handlers.explain.mockResolvedValue(4401);
    await last().drop(1006);
    expect(handlers.onClose).toHaveBeenCalledWith(
      expect.objectContaining({ title: "You are not logged in" }),
      4401,
      undefined,
    );
  });

  it("opens another channel at once when asked, also while it waits for a reason or for a channel to open", async () => {
    handlers.explain.mockReturnValue(new Promise(() => undefined));
    await last().drop(1006);
    client.retryNow();
    expect(FakeChannel.made).toHaveLength(2);
    client.retryNow();
    expect(FakeChannel.made).toHaveLength(3);
    last().accept();
    client.retryNow();
    expect(FakeChannel.made).toHaveLength(3);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(handlers.onClose).not.toHaveBeenCalled();
    expect(last().isOpen).toBe(true);
  });

  it("waits neither for a reason nor for a channel to open without a limit", async () => {
    handlers.explain.mockReturnValue(new Promise(() => undefined));
    await last().drop(1006);
    await vi.advanceTimersByTimeAsync(3000);
    expect(handlers.onClose).toHaveBeenCalledTimes(1);
    await vi.advanceTimersByTimeAsync(500);
    expect(FakeChannel.made).toHaveLength(2);
    await vi.advanceTimersByTimeAsync(10_000);
    expect(handlers.onClose).toHaveBeenCalledTimes(2);
  });

  it("asks on when the question for the reason fails", async () => {
    handlers.explain.mockRejectedValue(new Error("broken"));
    await last().drop(1006);
    expect(handlers.onClose).toHaveBeenCalledTimes(1);
  });

  it("resolves a command with its tick, rejects a refusal in the server's words", async () => {
    last().accept();
    const done = client.command({ kind: "pause" });
    const refused = client.command({ heal: ["x"] });
    last().say({ type: "reply", id: "c1", ok: true, tick: 42 });
    last().say({
      type: "reply",
      id: "c2",
      ok: false,
      error: { code: "invalid", message: "no such fault", field: "faults", hint: "" },
    });
    await expect(done).resolves.toBe(42);
    await expect(refused).rejects.toThrow("no such fault");
  });

  it("fails a command that is not answered, cut off or sent while offline", async () => {
    await expect(client.command({ kind: "pause" })).rejects.toThrow("not connected");
    last().accept();
    const silent = client.command({ kind: "pause" });
    const silence = expect(silent).rejects.toThrow("did not answer");
    await vi.advanceTimersByTimeAsync(5000);
    await silence;
    const cut = client.command({ kind: "pause" });
    const lost = expect(cut).rejects.toThrow("connection was lost");
    await last().drop(1006);
    await lost;
  });

  const sayFrame = (frame: number, panel: number) => {
    const picture = { panel, revision: 1, startTick: 0, endTick: 1, flags: 0, min: [[1]], max: [[1]], latest: [1] };
    last().say(encodeFrame({ frame, headTick: 77, dtMs: 0.01, panels: [picture] }));
  };

  it("only stores a frame; drawing acknowledges it", () => {
    const draw = vi.fn();
    const feed = client.feeds.open({ mode: "roll", signals: ["a"], window_ms: 1, width: 1 }, draw);
    last().accept();
    sayFrame(1, feed.panel);
    expect(client.head.tick).toBe(77);
    expect(draw).not.toHaveBeenCalled();
    client.feeds.draw();
    expect(draw).toHaveBeenCalledOnce();
    expect(types(last())).toEqual(["subscribe", "ack"]);
  });

  it("acknowledges at the next message what it will not draw, although no frame comes any more", () => {
    const draw = vi.fn();
    const feed = client.feeds.open({ mode: "roll", signals: ["a"], window_ms: 1, width: 1 }, draw);
    last().accept();
    sayFrame(1, feed.panel);
    sayFrame(2, feed.panel);
    expect(types(last())).toEqual(["subscribe"]);
    handlers.isDrawing.mockReturnValue(false);
    last().say({ type: "status" });
    last().say({ type: "status" });
    expect(
      last()
        .sent.slice(1)
        .map((text) => JSON.parse(text)),
    ).toEqual([
      { type: "took", statuses: 1 },
      { type: "ack", frame: 2 },
      { type: "took", statuses: 2 },
    ]);
    client.feeds.draw();
    expect(draw).toHaveBeenCalledOnce();
  });
});

it("waits 0.5, 1, 2, 5, 5 s in the middle of the jitter", () => {
  expect([0, 1, 2, 3, 9].map((n) => reconnectDelay(n, () => 0.5))).toEqual([500, 1000, 2000, 5000, 5000]);
});

it("jitters by at most 20 % so that many pages do not return at once", () => {
  expect(reconnectDelay(0, () => 0)).toBeCloseTo(400);
  expect(reconnectDelay(3, () => 1)).toBeCloseTo(6000);
});
