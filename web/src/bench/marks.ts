import type { LogEntry } from "../api/types";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/current-events";
import { type FaultSpan, faultSpans } from "./fault-spans";

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
    known = { events, faults, marks: { events: current, faults: faultSpans(current, faults) } };
  }
  return known.marks;
}
