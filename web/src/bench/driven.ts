import type { LogEntry } from "../api/types";

/** A time for which a controller drove, in ticks; without end for the driving controller. */
export interface Driven {
  name: string;
  from: number;
  until: number;
}

/** The controllers that drove one after another, the newest first. A switch in another slot is left out. */
export function drivenBy(controller: string, events: readonly LogEntry[]): Driven[] {
  const driven: Driven[] = [];
  let now = { name: controller, until: Number.POSITIVE_INFINITY };
  for (const { kind, old, new: name, tick } of [...events].reverse()) {
    if (kind !== "switch" || name !== now.name) continue;
    driven.push({ ...now, from: tick });
    now = { name: String(old), until: tick };
  }
  return [...driven, { ...now, from: 0 }];
}
