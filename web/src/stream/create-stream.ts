import { api, benchExists } from "../api/api";
import type { Bench, LogEntry, Score } from "../api/types";
import { setUnits } from "../api/use-catalog";
import { type Connection, mergeStatus, useBench } from "./bench-store";
import { DrawLoop } from "./draw-loop";
import { appendEvent } from "./event-log";
import { NOTHING_SAID, narrate } from "./narration";
import { StreamClient } from "./stream-client";
import type { Transport } from "./transport";
import type { ServerMessage } from "./wire";

const STALE_MS = 1000;
const WATCH_MS = 250;

const patch = (connection: Partial<Connection>) =>
  useBench.setState((s) => ({ connection: { ...s.connection, ...connection } }));

export type Stream = ReturnType<typeof createStream>;

/** A stream over channels of a transport, with its animation loop; it writes the state of the bench into `useBench`. */
export function createStream(transport: Transport) {
  let benchId = "";
  let serverId = "";
  let pendingEvents: LogEntry[] = [];
  let flush: ReturnType<typeof setTimeout> | undefined;
  let known: { bench: Bench | undefined; scores: Record<string, Score> } = { bench: undefined, scores: {} };

  /** The texts of the units whose cards the page has. */
  let shownUnits: unknown;

  const client = new StreamClient(
    {
      onMessage: receive,
      onOpen: () => patch({ phase: "open", reason: undefined, retryAt: undefined }),
      // A hidden page gets no animation frames and slow timers; the server must not take it for a dead one.
      isDrawing: () => !document.hidden && performance.now() - loop.lastFrame <= STALE_MS,
      onClose: (reason, _code, retryAt) => {
        if (retryAt !== undefined) return patch({ phase: "waiting", reason, retryAt });
        patch({
          phase: "closed",
          reason,
          retryAt,
          staleSince: useBench.getState().connection.staleSince ?? new Date(),
        });
      },
      explain: () => benchExists(benchId),
    },
    transport,
  );

  const loop = new DrawLoop();
  const stopDrawing = loop.add(() => client.feeds.draw());

  /** Show a bench. With `keep` the one before stays in sight until the server has said hello. */
  function open(id: string, keep = false): void {
    benchId = id;
    pendingEvents = [];
    client.head = { tick: 0, dtMs: 0, running: false };
    known = { bench: undefined, scores: {} };
    if (!keep) {
      tell();
      useBench.setState({ events: [], narration: NOTHING_SAID });
    }
    useBench.setState({ droppedFrames: 0, notice: undefined });
    patch({ phase: "connecting", reason: undefined, retryAt: undefined, staleSince: undefined });
    client.connect(id);
  }

  function receive(message: ServerMessage): void {
    switch (message.type) {
      case "hello": {
        const restarted = serverId !== "" && serverId !== message.server;
        serverId = message.server;
        // while a fault is hidden the server keeps a log of its own for the page
        const turned = known.bench !== undefined && known.bench.blind?.id !== message.bench.blind?.id;
        if (restarted || turned || !known.bench) {
          pendingEvents = [];
          useBench.setState({ events: [] });
        }
        patch({ staleSince: undefined });
        // back after a break, in which the page may have missed that it was called
        if (known.bench) useBench.setState((s) => ({ called: s.called + 1 }));
        known = { bench: message.bench, scores: turned ? {} : known.scores };
        setUnits(message.bench.units);
        shownUnits = message.bench.parameters.units;
        tell();
        const last = useBench.getState().events.at(-1)?.seq ?? 0;
        if (message.last_event > last) client.send({ type: "resume", after: last });
        return;
      }
      case "status": {
        const bench = known.bench && mergeStatus(known.bench, message);
        if (bench && bench.parameters.units !== known.bench?.parameters.units) void refreshUnits(bench);
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
        if (pendingEvents.length === 0) flush = setTimeout(flushEvents, 30);
        pendingEvents.push(...message.events);
        return;
      case "narration":
        useBench.setState((s) => ({ narration: narrate(s.narration, message) }));
        return;
      case "captures":
        client.feeds.captured(message);
        return;
      case "notice":
        if (message.code === "ask_me") useBench.setState((s) => ({ called: s.called + 1 }));
        else useBench.setState({ notice: { code: message.code, message: message.message } });
        return;
      case "error":
        client.feeds.refused();
        // back on a bench where a fault is hidden, a panel asks for hidden signals before the page knows of it
        if (known.bench?.blind && message.error.field === "signals") return;
        if (message.error.field?.startsWith("behind.")) {
          useBench.setState((s) => ({ behindRefused: s.behindRefused + 1 }));
          return;
        }
        console.error("the server refused a message", message.error);
        useBench.setState({ notice: { code: message.error.code, message: message.error.message } });
        return;
      case "reply":
      case "ping": // answered where it arrives
        return;
    }
  }

  /** After a reset with another text of a unit: its card may say something else. */
  async function refreshUnits({ id, parameters: { units } }: Bench): Promise<void> {
    if (JSON.stringify(units) === JSON.stringify(shownUnits)) return;
    shownUnits = units;
    const bench = await api.bench(id).catch(() => undefined);
    if (bench && id === benchId) setUnits(bench.units);
  }

  function flushEvents(): void {
    const events = pendingEvents.reduce(appendEvent, useBench.getState().events);
    pendingEvents = [];
    useBench.setState({ events });
    client.feeds.redraw();
  }

  /** Write the known state into the store. */
  function tell(): void {
    if (known.bench?.faults !== useBench.getState().bench?.faults) client.feeds.redraw();
    useBench.setState({ ...known, blind: Boolean(known.bench?.blind) });
  }

  let looked = performance.now();
  const watch = setInterval(() => {
    const { phase, staleSince } = useBench.getState().connection;
    const now = performance.now();
    const wasBusy = now - looked > 2 * WATCH_MS;
    looked = now;
    if (phase === "idle" || phase === "closed" || wasBusy) return; // a busy page has not listened
    const silent = now - client.lastHeard;
    if (silent > STALE_MS && !staleSince) patch({ staleSince: new Date(Date.now() - silent) });
    if (silent <= STALE_MS && staleSince) patch({ staleSince: undefined });
  }, WATCH_MS);

  /** End the stream: nothing is sent, heard or drawn any more. */
  function close(): void {
    clearInterval(watch);
    clearTimeout(flush);
    client.disconnect();
    stopDrawing();
  }

  return { client, loop, open, retry: () => client.retryNow(), close };
}
