import { create } from "zustand";
import type { Bench, LogEntry } from "../api/types";
import { useBench } from "../stream/bench-store";
import { jump } from "../ui/hover";
import { announce } from "./announce";
import { marksNow } from "./marks";

/** A slider rests once it has not moved for so long. */
export const REST_MS = 1000;

/** The last change of the device or of its drive: a fault, a healing, a switch, or parameters that were set. */
export interface Change {
  /** All that changed at its tick; of a slider the first and the last value. */
  events: LogEntry[];
  /** Where "before" ends, and where "after" begins: apart while a slider moved. */
  tick: number;
  since: number;
}

interface ChangeStore {
  change: Change | undefined;
  /** The change whose comparison was dismissed, by its number. */
  dismissed: number;
}

export const useChange = create<ChangeStore>(() => ({ change: undefined, dismissed: 0 }));

const numberOf = ({ events }: Change): number => events[events.length - 1].seq;

export function dismissChange(): void {
  const { change } = useChange.getState();
  if (change) useChange.setState({ change: undefined, dismissed: numberOf(change) });
}

const isChange = ({ kind, command, old }: LogEntry): boolean =>
  kind === "inject" ||
  kind === "switch" ||
  (kind === "set" && Boolean(command)) ||
  (kind === "heal" && Object.keys((old as object | null) ?? {}).length > 0);

/** The last change within some ticks; a change at tick 0 has no state before it. */
export function lastChange(events: readonly LogEntry[], from: number, until: number): Change | undefined {
  const changes = events.filter((e) => isChange(e) && e.tick > 0 && e.tick >= from && e.tick <= until);
  const last = changes.at(-1);
  if (!last) return undefined;
  if (last.kind !== "set")
    return { events: changes.filter(({ tick }) => tick === last.tick), tick: last.tick, since: last.tick };
  const first = firstOf(changes);
  return { events: first === last ? [last] : [first, last], tick: first.tick, since: last.tick };
}

/** Where the slider began to move that set the last of some changes. */
function firstOf(changes: readonly LogEntry[]): LogEntry {
  let first = changes[changes.length - 1];
  for (let i = changes.length - 2; i >= 0; i -= 1) {
    const before = changes[i];
    if (pathsOf(before) !== pathsOf(first) || Date.parse(first.at) - Date.parse(before.at) > REST_MS) break;
    first = before;
  }
  return first;
}

const pathsOf = ({ command }: LogEntry): string =>
  command && "set" in command ? Object.keys(command.set).sort().join() : "";

/** Tick from which changes are compared: earlier ones happened before the page came to the bench. */
let from = 0;
let resting: { seq: number; timer: ReturnType<typeof setTimeout> } | undefined;
/** The last setting that has come to rest. */
let rested = 0;

const isSameRun = (one: Bench, other: Bench): boolean =>
  (other.origin?.is_past && other.origin.bench === one.id) ||
  (one.origin?.is_past && one.origin.bench === other.id) ||
  false;

useBench.subscribe((now, before) => {
  const { bench } = now;
  const was = before.bench;
  if (bench === was && now.events === before.events) return;
  if (bench && was !== bench) {
    const isOther = !was || (was.id !== bench.id && !isSameRun(was, bench)) || was.blind?.id !== bench.blind?.id;
    if (isOther) {
      [from, rested] = [bench.tick, 0];
      useChange.setState({ dismissed: 0 });
    } else if (bench.tick < was.tick) from = Math.min(from, bench.tick); // a reset, or a moment before
  }
  follow();
});

/** Compare the last change; a slider once it rests. */
function follow(): void {
  const { bench } = useBench.getState();
  const { change: shown, dismissed } = useChange.getState();
  const found = bench && lastChange(marksNow().events, from, bench.tick);
  const seq = found ? numberOf(found) : 0;
  if (found?.events[0].kind === "set" && seq !== rested) {
    rest(seq);
    return;
  }
  clearTimeout(resting?.timer);
  resting = undefined;
  const next = seq === dismissed ? undefined : found;
  if ((next && numberOf(next)) !== (shown && numberOf(shown))) useChange.setState({ change: next });
}

function rest(seq: number): void {
  if (resting?.seq === seq) return;
  clearTimeout(resting?.timer);
  const timer = setTimeout(() => {
    rested = seq;
    follow();
  }, REST_MS);
  resting = { seq, timer };
}

jump.listen((target) => {
  const { change } = useChange.getState();
  if (change && target !== "live" && target.tick < change.tick) dismissChange();
});

/** A comparison on the page, as it makes its slide. */
export interface Comparison {
  /** How much the picture changed; without bound while the pointer is on it. */
  strength(): number;
  make(): void;
}

export const comparisons = new Set<Comparison>();

/** Keep the comparison that changed most, or is pointed at, as a slide. */
export function makeSlide(): void {
  const [most] = [...comparisons].sort((a, b) => b.strength() - a.strength());
  if (most) most.make();
  else announce("There is nothing to compare: nothing has changed.");
}
