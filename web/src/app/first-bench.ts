import { api } from "../api/api";
import { benchInAddress, lastBench, openBench } from "../bench/open-bench";
import { send } from "../bench/send";
import { useBench } from "../stream/bench-store";

/** Worth seeing at first sight: the first of these that the library has. */
const SHOWPIECES = ["first-look", "live", "ch5-seven-step"];

/** Open the bench of the address, else one that is running, else start the showpiece. */
export async function openFirstBench(): Promise<void> {
  const named = benchInAddress();
  if (named) return openBench(named, true);
  await openAnyBench();
}

/** Start a bench of a library scenario in place of the one shown. */
export async function startAgain(scenario: string): Promise<void> {
  openBench((await api.createBench({ scenario, paused: false, quiet_lead: true })).id, true);
}

/** Start a bench of a library scenario; the one shown is paused if nobody else watches it. */
export async function startBeside(scenario: string): Promise<void> {
  const { bench } = useBench.getState();
  const made = await api.createBench({ scenario, paused: false, quiet_lead: true });
  if (bench?.state === "running" && (bench.watchers ?? 0) <= 1) await send({ kind: "pause" });
  openBench(made.id);
}

/** Open the bench this browser had last, else one that runs, or start the showpiece. */
export async function openAnyBench(): Promise<void> {
  const benches = (await api.benches()).filter((b) => !b.replay_of);
  const mine = benches.find((b) => b.id === lastBench() && b.state !== "tripped");
  const running = mine ?? benches.find((b) => b.state === "running");
  if (running) return openBench(running.id, true);
  const library = await api.scenarios();
  const id = SHOWPIECES.find((name) => library.some((s) => s.id === name)) ?? library[0]?.id;
  if (!id) throw new Error("The library holds no scenario to start from.");
  openBench((await api.createBench({ scenario: id, paused: false, quiet_lead: true })).id, true);
}
