import { useBench } from "../stream/bench-store";
import { flagWords } from "./flag-words";
import { send } from "./send";

export type Way = "undo" | "redo";

/** When this page first saw a change of the bench, by the number of its event; undo orders it among the changes of the layout. */
const seen = new Map<number, number>();

/** A change of the bench that can be taken back or made again. */
interface BenchChange {
  text: string;
  at: number;
}

/** What undo or redo would do to the bench; nothing while a fault is to be found, which it would tell. */
export function benchChange(way: Way): BenchChange | undefined {
  const { bench, blind, events } = useBench.getState();
  const change = bench?.[way];
  if (!change || blind) return undefined;
  const at = seen.get(change.seq) ?? performance.now();
  seen.set(change.seq, at);
  const event = events.find(({ seq }) => seq === change.seq);
  return { text: event ? flagWords(event) : change.text, at };
}

/** Note new changes of the bench as they come, so that their order among changes of the layout is known. */
useBench.subscribe((now, before) => {
  if (now.bench?.undo?.seq !== before.bench?.undo?.seq) benchChange("undo");
});

/** Take the last change of the bench back, or make it again. */
export const changeBench = (way: Way): Promise<boolean> =>
  send({ kind: way }, `${way === "undo" ? "Undone" : "Done again"}: ${benchChange(way)?.text ?? ""}`);
