import type { LogEntry } from "../api/types";

/** How loudly an event speaks: faults and trips are alarms, what a diagnoser found is news, run control is quiet. */
export type EventTone = "alarm" | "found" | "change" | "quiet";

const TONES: Record<string, EventTone> = {
  inject: "alarm",
  tripped: "alarm",
  recognised: "found",
  heal: "change",
  set: "change",
  switch: "change",
  truth_changed: "change",
  reset_trip: "change",
  failed: "alarm",
  refused: "alarm",
  scheduled: "change",
  reset: "change",
  restored: "change",
};

export function eventTone(event: Pick<LogEntry, "kind">): EventTone {
  return TONES[event.kind] ?? "quiet";
}
