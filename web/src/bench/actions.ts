import { notifications } from "@mantine/notifications";
import { api } from "../api/api";
import { may } from "../api/me";
import { cardOf, slotMates } from "../api/use-catalog";
import { useBench } from "../stream/bench-store";
import { jump } from "../ui/hover";
import { saveFile } from "../ui/save-file";
import { layoutNow } from "./dock";
import { openOwn } from "./open-bench";
import { forkBeforeTrip } from "./past";
import type { PageName } from "./places";
import { onBench, send } from "./send";
import { sendAndTell } from "./tell";
import { stepTimeScale } from "./time-scale";
import { setPage, useView } from "./view-store";

const bench = () => useBench.getState().bench;

/** The actions on the bench that buttons and keys share. */
export const actions = {
  toggle: () =>
    void (bench()?.state === "running" ? send({ kind: "pause" }, "Paused") : send({ kind: "start" }, "Running")),
  pause: () => void send({ kind: "pause" }, "Paused"),
  stepTick: () => void send({ kind: "step", ticks: 1 }, "One tick"),
  stepPeriod: () => void send({ kind: "step_period" }, "One period"),
  reset: () => {
    jump.to("live");
    useView.setState({ sample: undefined });
    void sendAndTell({ kind: "reset" }, "Reset to the start");
  },
  /** On to just before the next step of the scenario. */
  skip: () => void send({ kind: "fast_forward" }, "Skipped on"),
  /** Begin the scenario again, just before a step. */
  replayStep: (tick: number | undefined) => {
    jump.to("live");
    useView.setState({ sample: undefined });
    void replay(tick || undefined);
  },
  resetTrip: () => void sendAndTell({ reset_trip: true }, "Trip reset"),
  faster: () => scale(2),
  slower: () => scale(0.5),
  healAll: () => void sendAndTell({ heal: "all" }, "All faults healed"),
  live: () => jump.to("live"),
  controller: (controller: string, cold = false) => void send({ switch: controller, cold }, `Controller ${controller}`),
  nextController: () => {
    const { controllers = [], controller = "" } = bench() ?? {};
    const others = slotMates(controller, controllers);
    const next = others[(others.indexOf(controller) + 1) % others.length];
    if (next) void sendAndTell({ switch: next }, `${cardOf("control", next)?.title ?? next} drives`);
  },
  keys: () => useView.setState({ dialog: "keys" }),
  newBench: () => useView.setState({ dialog: "bench" }),
  share: () => useView.setState({ dialog: "share" }),
  /** To a page, and back to the bench from there. */
  page: (name: PageName) => setPage(useView.getState().page === name ? "bench" : name),
  fork: () => void fork(),
  forkBeforeTrip: () => void forkBeforeTrip(),
  keep: () => void keep(),
  record: () => void record(),
  saveScenario: () => void saveScenario(),
  exportFile: () => void exportFile(),
};

function scale(factor: number): void {
  void send({ kind: "time_scale", value: stepTimeScale(bench()?.time_scale ?? null, factor) });
}

async function replay(before_tick: number | undefined): Promise<void> {
  const began = await send({ kind: "reset", values: {}, before_tick }, "The step again");
  if (began && bench()?.state === "paused") void send({ kind: "start" });
}

const fork = onBench(async (from) => {
  const made = await api.fork(from.id);
  openOwn(made.id);
  notifications.show({ title: "Forked", message: `This is a copy of ${from.title}; the original is untouched.` });
});

/** Start a recording that includes the last moments, or stop it. */
const record = onBench(async (from) => {
  if (from.recording.length > 0) {
    for (const id of from.recording) await api.stopRecording(from.id, id);
    notifications.show({
      title: "Recorded",
      message: `${may("teach") ? "Replay, download or compare" : "Download"} it under Compare › Recordings.`,
    });
  } else {
    await api.record(from.id, { name: from.title.slice(0, 100) || "recording", layout: layoutNow() ?? null });
  }
});

/** Keep this moment as a mark on the timeline. */
const keep = onBench(async (from) => {
  const kept = await api.keep(from.id);
  notifications.show({ title: "Moment kept", message: `Tick ${kept.tick} stands on the timeline.` });
});

const saveScenario = onBench(async (from) => {
  const toml = await api.scenarioToml(from.id);
  const name = `${from.scenario_id || "bench"}-${from.tick}.toml`;
  saveFile(name, new Blob([toml], { type: "application/toml" }));
  const digest = /^# .*digest ([0-9a-f]+)/m.exec(toml)?.[1];
  notifications.show({
    title: "Saved as a scenario",
    message: `Run it again with: combbench run ${name}. It gives the same bits${digest ? `, digest ${digest.slice(0, 12)}…` : ""}.`,
    autoClose: 15_000,
  });
});

/** Save the bench as it is set now as a file that runs without a server. */
const exportFile = onBench(async (from) => {
  const id = "export";
  notifications.show({
    id,
    loading: true,
    autoClose: false,
    title: "Making the file",
    message: "Its blocks are compiled for browsers: seconds, and a minute or more the first time.",
  });
  const html = await api.benchFile(from.id).finally(() => notifications.hide(id));
  saveFile(`${from.scenario_id || "bench"}.html`, new Blob([html], { type: "text/html" }));
  notifications.show({
    title: "Exported as a file",
    message: "Any browser runs it, without a server and offline. It begins at tick 0.",
    autoClose: 10_000,
  });
});
