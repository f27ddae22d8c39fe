import type { LogEntry } from "../api/types";

/** The events of the present run: a reset begins a new one, going back to a snapshot undoes what came after it. */
export function currentEvents(events: readonly LogEntry[]): LogEntry[] {
  let kept: LogEntry[] = [];
  for (const event of events) {
    if (event.kind === "reset") kept = [];
    if (event.kind === "restored") kept = kept.filter((e) => e.tick <= event.tick);
    kept.push(event);
  }
  return kept;
}
