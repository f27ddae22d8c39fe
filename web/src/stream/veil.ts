import type { Bench, LogEntry } from "../api/types";

/** Events that give a hidden fault away. */
const TELLING = ["inject", "scheduled", "truth_changed", "recognised", "heal"];

let on = false;
let held: LogEntry[] = [];

/**
 * Keeps a hidden fault from the page while it is to be found: what acts, what waits, and the log of it.
 *
 * The traces stay what they are; a veil is a game's courtesy, not a lock.
 */
export const veil = {
  get on(): boolean {
    return on;
  },
  drop(): void {
    on = true;
  },
  /** Lift it; returns the events that were held back. */
  lift(): LogEntry[] {
    on = false;
    const events = held;
    held = [];
    return events;
  },
  status<T extends Partial<Pick<Bench, "faults" | "pending">>>(status: T): T {
    return on ? { ...status, faults: [], pending: [] } : status;
  },
  events(events: LogEntry[]): LogEntry[] {
    if (!on) return events;
    held.push(...events.filter(tells));
    return events.filter((event) => !tells(event));
  },
};

const tells = (event: LogEntry): boolean => TELLING.includes(event.kind) || event.command?.kind === "inject";
