import type { LogEntry } from "../api/types";

/** An event with the given parts, for tests. */
export function logEntry(part: Partial<LogEntry>): LogEntry {
  return {
    seq: 1,
    tick: 0,
    actor: "page 1",
    kind: "set",
    text: "",
    command: null,
    old: null,
    new: null,
    at: "2026-01-01T00:00:00Z",
    ...part,
  };
}
