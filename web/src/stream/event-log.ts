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
