import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { openSocket } from "./socket";

/** A WebSocket without a network. */
class FakeSocket {
  static readonly OPEN = 1;
  static last: FakeSocket;
  readyState = 0;
  onopen: (() => void) | undefined;
  onmessage: ((event: { data: unknown }) => void) | undefined;
  onclose: ((event: { code: number }) => void) | undefined;
  readonly send = vi.fn();
  readonly close = vi.fn();
  readonly url: string;
  readonly protocols: string[];

  constructor(url: string, protocols: string[]) {
    this.url = url;
    this.protocols = protocols;
    FakeSocket.last = this;
  }
}

beforeEach(() => {
  vi.stubGlobal("WebSocket", FakeSocket);
  vi.stubGlobal("document", { baseURI: "https://lab/comb/?page=bench" });
});
afterEach(() => vi.unstubAllGlobals());

it("opens the stream of a bench below the address of the page, with the wire version as its protocol", () => {
  openSocket("a b", { onOpen: vi.fn(), onMessage: vi.fn(), onClose: vi.fn() });
  expect(FakeSocket.last.url).toBe("wss://lab/comb/api/v1/benches/a%20b/stream");
  expect(FakeSocket.last.protocols).toEqual(["combbench.v2"]);
});

it("hands on what happens, and sends and closes", () => {
  const events = { onOpen: vi.fn(), onMessage: vi.fn(), onClose: vi.fn() };
  const channel = openSocket("b", events);
  const socket = FakeSocket.last;
  expect(channel.isOpen).toBe(false);
  socket.readyState = 1;
  socket.onopen?.();
  expect(channel.isOpen).toBe(true);
  expect(events.onOpen).toHaveBeenCalledOnce();
  socket.onmessage?.({ data: "{}" });
  expect(events.onMessage).toHaveBeenCalledWith("{}");
  channel.send("hello");
  expect(socket.send).toHaveBeenCalledWith("hello");
  channel.close();
  expect(socket.close).toHaveBeenCalledWith(1000);
  socket.onclose?.({ code: 4404 });
  expect(events.onClose).toHaveBeenCalledWith(4404);
});
