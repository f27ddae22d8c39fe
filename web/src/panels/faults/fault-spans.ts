import type { LogEntry } from "../../api/types";

export interface FaultSpan {
  name: string;
  severity: number;
  start: number;
  /** Tick at which it was healed; undefined while it acts. */
  end: number | undefined;
}

/** When each fault acted, from the log of commands. */
export function faultSpans(events: readonly LogEntry[]): FaultSpan[] {
  const spans: FaultSpan[] = [];
  const open = new Map<string, FaultSpan>();
  const close = (name: string, tick: number) => {
    const span = open.get(name);
    if (span) span.end = tick;
    open.delete(name);
  };
  for (const { kind, command, tick } of events) {
    if (kind === "reset") for (const name of [...open.keys()]) close(name, tick);
    if (kind === "inject" && command) {
      const name = String(command.fault);
      close(name, tick);
      const span = { name, severity: Number(command.severity), start: tick, end: undefined };
      open.set(name, span);
      spans.push(span);
    }
    if (kind === "heal" && command) {
      const healed = Array.isArray(command.faults) ? command.faults.map(String) : [...open.keys()];
      for (const name of healed) close(name, tick);
    }
  }
  return spans;
}
