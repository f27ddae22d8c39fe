import { api } from "../api/api";
import { useBench } from "../stream/bench-store";
import { openBench } from "./open-bench";

let before: string | undefined;

/** The bench a replay was begun from, to go back to. */
export const benchBefore = (): string | undefined => before;

/** Play a recording in this page. */
export async function openReplay(recording: string): Promise<void> {
  const from = useBench.getState().bench;
  if (from && !from.replay_of) before = from.id;
  openBench((await api.replay(recording)).id);
}
