import { api } from "../api/api";
import { addBehind } from "./behind";
import { showError } from "./send";

/** Play a recording on a bench of its own, as fast as it goes, and put it behind the traces. */
export async function showRecording(id: string): Promise<void> {
  try {
    const made = await api.replay(id);
    await api.runFast(made.id);
    await addBehind(made.id);
  } catch (error) {
    showError(error);
  }
}

/** Carry a headless run out again on a bench, which has the same bits, and put it behind the traces. */
export async function showRun(id: string): Promise<void> {
  try {
    const made = await api.createBench({ scenario: await api.runScenario(id), time_scale: null });
    await addBehind(made.id);
  } catch (error) {
    showError(error);
  }
}
