import type { Bench, LogEntry, Score, Signal } from "../api/types";

/** Events that give a hidden fault away, or say what a diagnoser takes it for. */
const TELLING = [
  ...["inject", "scheduled", "heal", "truth_changed", "recognised"],
  ...["verdict", "region", "alarm", "unexcited"],
];

/** Signals that are the fault itself, or know of it; of twins too. */
const TRUTHS = /^(?:[^:]+:)?(?:faults|effects)\.|_(?:true|ideal)(?:\.|$)|\.(?:truth|error_pct)(?:\.|$)/;

const NONE: never[] = [];
const UNSCORED: Record<string, Score> = {};

/** The bench that hides a fault, and the one that is shown. */
let hiding: string | undefined;
let shown: string | undefined;
let held: LogEntry[] = [];

/**
 * Keeps a hidden fault from the page while it is to be found: what acts, what waits, the signals that know of it, what
 * the diagnosers say, and the log of it.
 *
 * It lies over one bench, and is there again when that bench is shown again. The traces stay what they are; a veil is a
 * game's courtesy, not a lock.
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
  bench(bench: Bench): Bench {
    return veil.on ? { ...bench, faults: NONE, pending: NONE, signals: harmless(bench) } : bench;
  },
  scores(scores: Record<string, Score>): Record<string, Score> {
    return veil.on ? UNSCORED : scores;
  },
  events(events: LogEntry[]): LogEntry[] {
    if (!veil.on) return events;
    held.push(...events.filter(tells));
    return events.filter((event) => !tells(event));
  },
};

const tells = ({ kind, command }: LogEntry): boolean =>
  TELLING.includes(kind) || Boolean(command && "fault" in command);

const harmlessOf = new WeakMap<Signal[], Signal[]>();

/** The signals that may be seen: none of a diagnoser, and none that knows the truth. The same list for the same bench. */
function harmless({ signals, diagnosers }: Bench): Signal[] {
  const known = harmlessOf.get(signals);
  if (known) return known;
  const blocks = new Set(Object.keys(diagnosers));
  const kept = signals.filter(
    ({ name }) =>
      !TRUTHS.test(name) && !blocks.has(name.replace(/^[^:]+:/, "").split(".")[0]) && !blocks.has(name.split(".")[0]),
  );
  harmlessOf.set(signals, kept);
  return kept;
}
