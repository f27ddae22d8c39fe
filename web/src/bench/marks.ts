import type { ActiveFault, LogEntry } from "../api/types";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/event-log";

export interface Marks {
  events: LogEntry[];
  faults: FaultSpan[];
}

let known: { events: unknown; faults: unknown; marks: Marks } | undefined;

/** Events and fault spans, worked out once per change rather than once per frame. */
export function marksNow(): Marks {
  const { events, bench } = useBench.getState();
  const faults = bench?.faults;
  if (known?.events !== events || known.faults !== faults) {
    const current = currentEvents(events);
    known = { events, faults, marks: { events: current, faults: faultSpans(current, faults, bench?.tick) } };
  }
  return known.marks;
}

interface FaultSpan {
  name: string;
  severity: number;
  start: number;
  /** Tick at which it was healed; undefined while it acts. */
  end: number | undefined;
}

/**
 * When each fault acted, from the log of commands.
 *
 * The faults acting at `now` have the last word: one may have begun before the log, as on a fork, and one may have ended
 * unheard, as while the connection was lost.
 */
export function faultSpans(
  events: readonly LogEntry[],
  acting: readonly ActiveFault[] = [],
  now = Number.NEGATIVE_INFINITY,
): FaultSpan[] {
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
      if (severity === 0) continue;
      const span = { name, severity, start: tick, end: undefined };
      open.set(name, span);
      spans.push(span);
    }
    if (kind === "heal" && command && "heal" in command) {
      const healed = command.heal === "all" ? [...open.keys()] : command.heal;
      for (const name of healed) close(name, tick);
    }
  }
  const acts = new Set(acting.flatMap(({ name, severity }) => (severity === 0 ? [] : name)));
  for (const { name, start } of open.values()) if (!acts.has(name) && start < now) close(name, now);
  for (const { name, severity, since_tick } of acting)
    if (severity !== 0 && !open.has(name)) spans.push({ name, severity, start: since_tick, end: undefined });
  return spans;
}
