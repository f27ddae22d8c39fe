import { benchExists } from "../api/api";
import type { Bench, LogEntry, Score } from "../api/types";
import { type Connection, mergeStatus, useBench } from "./bench-store";
import { DrawLoop } from "./draw-loop";
import { appendEvent } from "./event-log";
import { StreamClient } from "./stream-client";
import { veil } from "./veil";
import type { ServerMessage } from "./wire";

const STALE_MS = 1000;

let benchId = "";
let serverId = "";
let pendingEvents: LogEntry[] = [];
/** What the server said of the bench; the store has it as the veil lets it through. */
let known: { bench: Bench | undefined; scores: Record<string, Score> } = { bench: undefined, scores: {} };

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
  known = { bench: undefined, scores: {} };
  tell();
  useBench.setState({ events: [], droppedFrames: 0, notice: undefined });
  patch({ phase: "connecting", reason: undefined, retryAt: undefined, staleSince: undefined });
  const url = new URL(`./api/v1/benches/${encodeURIComponent(id)}/stream`, document.baseURI);
  client.connect(url.href.replace(/^http/, "ws"));
}

function receive(message: ServerMessage): void {
  switch (message.type) {
    case "hello": {
      const restarted = serverId !== "" && serverId !== message.server;
      serverId = message.server;
      if (restarted) useBench.setState({ events: [] });
      known.bench = message.bench;
      tell();
      const last = useBench.getState().events.at(-1)?.seq ?? 0;
      if (message.last_event > last) client.send({ type: "resume", after: last });
      return;
    }
    case "status": {
      const bench = known.bench && mergeStatus(known.bench, message);
      const isScored = message.scores && JSON.stringify(message.scores) !== JSON.stringify(known.scores);
      const scores = isScored && message.scores ? message.scores : known.scores;
      if (bench !== known.bench || scores !== known.scores) {
        known = { bench, scores };
        tell();
      }
      if (message.dropped_frames !== undefined) useBench.setState({ droppedFrames: message.dropped_frames });
      return;
    }
    case "events":
      if (pendingEvents.length === 0) setTimeout(flushEvents, 30);
      pendingEvents.push(...message.events);
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

/** Put what is known into the store, as far as it may be seen. */
function tell(): void {
  useBench.setState({
    blind: veil.on,
    bench: known.bench && veil.bench(known.bench),
    scores: veil.scores(known.scores),
  });
}

/** Hide what tells the fault of a bench. */
export function dropVeil(bench: string): void {
  veil.drop(bench);
  tell();
  useBench.setState({ events: veil.events(useBench.getState().events) });
}

/** Show again what was hidden. */
export function liftVeil(): void {
  useBench.setState({ events: veil.lift().reduce(appendEvent, useBench.getState().events) });
  tell();
}

setInterval(() => {
  const { connection } = useBench.getState();
  if (connection.phase !== "open") return;
  const silent = performance.now() - client.lastHeard;
  if (silent > STALE_MS && !connection.staleSince) patch({ staleSince: new Date(Date.now() - silent) });
  if (silent <= STALE_MS && connection.staleSince) patch({ staleSince: undefined });
}, 250);
