import { api } from "../api/api";
import { addBehind } from "./behind";
import { showing } from "./send";

/** Play a recording on a bench of its own, as fast as it goes, and put it behind the traces. */
export const showRecording = showing(async (id: string) => {
  const made = await api.replay(id);
  await api.runFast(made.id);
  await addBehind(made.id);
});

/** Carry a headless run out again on a bench, which has the same bits, and put it behind the traces. */
export const showRun = showing(async (id: string) => {
  const made = await api.createBench({ scenario: await api.runScenario(id), time_scale: null });
  await addBehind(made.id);
});
