import type { LogEntry } from "../../api/types";

/** A change of the truth, and how long a diagnoser took to name it. */
export interface TruthSwitch {
  tick: number;
  label: string;
  /** Samples, or undefined while (or if never) found. */
  delay: number | undefined;
  /** Whether the truth is among the hypotheses at all; if not, there is nothing to find. */
  findable: boolean;
}

const NONE = "none of the hypotheses";

/** The truth's changes as one diagnoser met them, from the log. */
export function truthSwitches(events: readonly LogEntry[], diagnoser: string): TruthSwitch[] {
  const found: TruthSwitch[] = [];
  for (const event of events) {
    if (event.kind === "truth_changed" && event.text.startsWith(`${diagnoser}:`))
      found.push({ tick: event.tick, label: String(event.new), delay: undefined, findable: event.new !== NONE });
    const last = found.at(-1);
    if (event.kind === "recognised" && last && event.text.startsWith(`${diagnoser} `)) last.delay = Number(event.old);
  }
  return found;
}
