import type { Bench, LogEntry } from "../api/types";

/** Events that give a hidden fault away. */
const TELLING = ["inject", "scheduled", "truth_changed", "recognised", "heal"];

/** The bench that hides a fault, and the one that is shown. */
let hiding: string | undefined;
let shown: string | undefined;
let held: LogEntry[] = [];

/**
 * Keeps a hidden fault from the page while it is to be found: what acts, what waits, and the log of it.
 *
 * It lies over one bench, and is there again when that bench is shown again. The traces stay what they are; a veil is a game's courtesy, not a lock.
 */
export const veil = {
  get on(): boolean {
    return hiding !== undefined && hiding === shown;
  },
  /** Another bench is shown, whose log comes from its beginning. */
  show(bench: string): void {
    shown = bench;
    held = [];
  },
  drop(bench: string): void {
    hiding = bench;
  },
  /** Lift it; returns the events that were held back. */
  lift(): LogEntry[] {
    hiding = undefined;
    const events = held;
    held = [];
    return events;
  },
  status<T extends Partial<Pick<Bench, "faults" | "pending">>>(status: T): T {
    return veil.on ? { ...status, faults: [], pending: [] } : status;
  },
  events(events: LogEntry[]): LogEntry[] {
    if (!veil.on) return events;
    held.push(...events.filter(tells));
    return events.filter((event) => !tells(event));
  },
};

const tells = (event: LogEntry): boolean => TELLING.includes(event.kind) || event.command?.kind === "inject";
