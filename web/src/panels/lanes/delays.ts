import type { LogEntry } from "../../api/types";

/** A change of the truth, and how long a diagnoser took to name it. */
export interface TruthSwitch {
  tick: number;
  label: string;
  /** Samples, or undefined while (or if never) found; 0 where the diagnoser said so already and found nothing. */
  delay: number | undefined;
  /** Whether the truth is among the hypotheses at all; if not, there is nothing to find. */
  findable: boolean;
  /** No fault has acted yet; the delay is the time that the diagnoser takes to settle. */
  isStartUp: boolean;
}

/** The mean delay of the changes that a diagnoser found, in samples; its start-up and earlier verdicts do not count. */
export function meanDelay([_startUp, ...delays]: readonly (number | null)[]): number | undefined {
  const found = delays.flatMap((delay) => delay || []);
  return found.length > 0 ? found.reduce((sum, d) => sum + d, 0) / found.length : undefined;
}

const NONE = "none of the hypotheses";

/**
 * The changes of the truth with the delays of one diagnoser, from the log. The log of a twin is not kept: its findings are
 * repeated behind its name, and its truth is the truth of the board, which has the same faults.
 */
export function truthSwitches(events: readonly LogEntry[], diagnoser: string): TruthSwitch[] {
  const [own, twin] = diagnoser.split(":").reverse();
  const told = events.filter((event) => event.kind === "truth_changed");
  const teller = !twin || told.some((e) => e.text.startsWith(`${own}:`)) ? own : told[0]?.text.split(":")[0];
  const firstFault = events.find(({ kind }) => kind === "inject")?.tick ?? Number.POSITIVE_INFINITY;
  const found = told
    .filter((event) => event.text.startsWith(`${teller}:`))
    .map(({ tick, new: label }, i): TruthSwitch => {
      const isStartUp = i === 0 && tick < firstFault;
      return { tick, label: String(label), delay: undefined, findable: label !== NONE, isStartUp };
    });
  const head = twin ? `${twin}: ${own} ` : `${own} `;
  for (const event of events) {
    if (event.kind !== "recognised" || !event.text.startsWith(head)) continue;
    const change = found.findLast(({ tick }) => tick <= event.tick);
    if (change) change.delay = Number(event.old);
  }
  return found;
}

/**
 * Places by the delay of the latest change of the truth; equal delays share one. A diagnoser that has not found it has no
 * place, nor has a diagnoser with this verdict before: a bank that never leaves "healthy" is not quick. A start-up is no
 * race.
 */
export function racePlaces(switches: Record<string, TruthSwitch[]>): Record<string, number> {
  const latest = Math.max(...Object.values(switches).map((list) => list.at(-1)?.tick ?? -1));
  const found = Object.entries(switches).flatMap(([id, list]) => {
    const last = list.at(-1);
    return last && last.tick === latest && last.delay && !last.isStartUp ? [{ id, delay: last.delay }] : [];
  });
  return Object.fromEntries(found.map(({ id, delay }) => [id, 1 + found.filter((f) => f.delay < delay).length]));
}
