import type { ActiveFault, LogEntry } from "../api/types";

export interface FaultSpan {
  name: string;
  severity: number;
  start: number;
  /** Tick at which it was healed; undefined while it acts. */
  end: number | undefined;
}

/** When each fault acted, from the log of commands; what acts now may have begun before the log (on a fork). */
export function faultSpans(events: readonly LogEntry[], acting: readonly ActiveFault[] = []): FaultSpan[] {
  const spans: FaultSpan[] = [];
  const open = new Map<string, FaultSpan>();
  const close = (name: string, tick: number) => {
    const span = open.get(name);
    if (span) span.end = tick;
    open.delete(name);
  };
  for (const { kind, command, tick } of events) {
    if (kind === "inject" && command && "fault" in command) {
      const { fault: name, severity } = command;
      close(name, tick);
      const span = { name, severity, start: tick, end: undefined };
      open.set(name, span);
      spans.push(span);
    }
    if (kind === "heal" && command && "heal" in command) {
      const healed = command.heal === "all" ? [...open.keys()] : command.heal;
      for (const name of healed) close(name, tick);
    }
  }
  for (const { name, severity, since_tick } of acting)
    if (severity !== 0 && !open.has(name)) spans.push({ name, severity, start: since_tick, end: undefined });
  return spans;
}
