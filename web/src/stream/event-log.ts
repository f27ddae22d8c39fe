import type { LogEntry } from "../api/types";

const KEEP = 2000;

/** Add an event in order; one already known changes nothing, a replay may fill a gap. */
export function appendEvent(events: LogEntry[], event: LogEntry): LogEntry[] {
  const last = events.at(-1);
  if (!last || event.seq > last.seq) {
    const grown = [...events, event];
    return grown.length > KEEP ? grown.slice(-KEEP) : grown;
  }
  let at = events.length;
  while (at > 0 && events[at - 1].seq > event.seq) at -= 1;
  if (at > 0 && events[at - 1].seq === event.seq) return events;
  return [...events.slice(0, at), event, ...events.slice(at)];
}

/** The events of the present run: a reset begins a new run, and a return to a moment keeps the events before it. */
export function currentEvents(events: readonly LogEntry[]): LogEntry[] {
  const at = events.findLastIndex(({ kind }) => kind === "reset" || kind === "restored");
  if (at < 0) return [...events];
  const since = events.slice(at);
  if (since[0].kind === "reset") return since;
  const { tick, new: last } = since[0];
  // a recording made by an earlier version does not say which was the last, only the tick
  const led = (e: LogEntry) => (typeof last === "number" ? e.seq <= last : e.tick <= tick);
  return [...currentEvents(events.slice(0, at).filter(led)), ...since];
}
