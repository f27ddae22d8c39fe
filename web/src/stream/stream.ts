import { benchExists } from "../api/bench-exists";
import type { LogEntry } from "../api/types";
import { type Connection, useBench } from "./bench-store";
import { DrawLoop } from "./draw-loop";
import { appendEvent } from "./event-log";
import { mergeStatus } from "./merge-status";
import { StreamClient } from "./stream-client";
import { veil } from "./veil";
import type { ServerMessage } from "./wire";

const STALE_MS = 1000;

let benchId = "";
let serverId = "";
let pendingEvents: LogEntry[] = [];

const patch = (connection: Partial<Connection>) =>
  useBench.setState((s) => ({ connection: { ...s.connection, ...connection } }));

const client = new StreamClient({
  onMessage: receive,
  onOpen: () => patch({ phase: "open", reason: undefined, retryAt: undefined, staleSince: undefined }),
  // A hidden page gets no animation frames and slow timers; the server must not take it for a dead one.
  isDrawing: () => !document.hidden && performance.now() - loop.lastFrame <= STALE_MS,
  onClose: (reason, _code, retryAt) => {
    const since = useBench.getState().connection.staleSince ?? new Date();
    patch({ phase: retryAt === undefined ? "closed" : "waiting", reason, retryAt, staleSince: since });
  },
  explain: () => benchExists(benchId),
});

const loop = new DrawLoop();
loop.add(() => client.feeds.draw());

/** The page's single stream and its animation loop. */
export const stream = { client, loop, open, retry: () => client.retryNow() };

function open(id: string): void {
  benchId = id;
  veil.show(id);
  pendingEvents = [];
  client.head = { tick: 0, dtMs: 0, running: false };
  useBench.setState({ bench: undefined, scores: {}, events: [], droppedFrames: 0, notice: undefined });
  patch({ phase: "connecting", reason: undefined, retryAt: undefined, staleSince: undefined });
  const scheme = window.location.protocol === "https:" ? "wss" : "ws";
  client.connect(`${scheme}://${window.location.host}/api/v1/benches/${encodeURIComponent(id)}/stream`);
}

function receive(message: ServerMessage): void {
  switch (message.type) {
    case "hello": {
      const restarted = serverId !== "" && serverId !== message.server;
      serverId = message.server;
      if (restarted) useBench.setState({ events: [] });
      useBench.setState({ bench: veil.status(message.bench) });
      const last = useBench.getState().events.at(-1)?.seq ?? 0;
      if (message.last_event > last) client.send({ type: "resume", after: last });
      return;
    }
    case "status": {
      const { bench, scores } = useBench.getState();
      const next = bench && mergeStatus(bench, veil.status(message));
      if (next && next !== bench) useBench.setState({ bench: next });
      if (message.scores && JSON.stringify(message.scores) !== JSON.stringify(scores))
        useBench.setState({ scores: message.scores });
      if (message.dropped_frames !== undefined) useBench.setState({ droppedFrames: message.dropped_frames });
      return;
    }
    case "event":
      if (pendingEvents.length === 0) setTimeout(flushEvents, 30);
      pendingEvents.push(message.event);
      return;
    case "notice":
      useBench.setState({ notice: { code: message.code, message: message.message } });
      return;
    case "error":
      client.feeds.refused();
      console.error("the server refused a message", message.error);
      useBench.setState({ notice: { code: message.error.code, message: message.error.message } });
      return;
    case "reply":
      return;
  }
}

function flushEvents(): void {
  const events = veil.events(pendingEvents).reduce(appendEvent, useBench.getState().events);
  pendingEvents = [];
  useBench.setState({ events });
}

/** Show again what was hidden. */
export function liftVeil(): void {
  useBench.setState({ events: veil.lift().reduce(appendEvent, useBench.getState().events) });
}

setInterval(() => {
  const { connection } = useBench.getState();
  if (connection.phase !== "open") return;
  const silent = performance.now() - client.lastHeard;
  if (silent > STALE_MS && !connection.staleSince) patch({ staleSince: new Date(Date.now() - silent) });
  if (silent <= STALE_MS && connection.staleSince) patch({ staleSince: undefined });
}, 250);
