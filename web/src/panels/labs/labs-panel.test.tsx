import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount, words } from "../../testing/render";
import { LabsPanel } from "./labs-panel";

const { bench, status } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const SCALE = "diagnosers.kalman.assumed_noise_scale";

beforeEach(() => server.on("GET", "/catalog", catalog));

const variance = () => screen.findByRole("textbox", { name: "Assumed variance over true" });

/** The parameters of the bench with another variance. */
function withScale(assumed_noise_scale: number) {
  const diagnosers = bench.parameters.diagnosers as Record<string, object>;
  return { ...bench.parameters, diagnosers: { kalman: { ...diagnosers.kalman, assumed_noise_scale } } };
}

async function mountLabs() {
  const board = connect(bench);
  board.status(status);
  const { user } = mount(<LabsPanel />);
  const type = async (value: string) => {
    await user.clear(await variance());
    await user.type(await variance(), `${value}{Enter}`);
  };
  return { board, user, type };
}

it("groups the knobs by what is true and what the diagnoser assumes", async () => {
  await mountLabs();
  await variance();
  const knobs = (lab: string) =>
    within(screen.getByRole("region", { name: lab }))
      .getAllByRole("textbox")
      .map((box) => box.getAttribute("aria-label"));
  expect(knobs("True values")).toEqual([
    "True noise of the sensor, µm",
    "True noise on the drive, V",
    "Amplitude of the drive, V",
    "Frequency of the drive, Hz",
  ]);
  expect(knobs("Assumed values")).toEqual([
    "Assumed variance over true",
    "Assumed noise on the voltage, V",
    "Floor of the probabilities",
  ]);
});

it("sends the variance on Enter, once", async () => {
  const { board, user, type } = await mountLabs();
  await type("0.1");
  await user.tab();
  expect(board.commands).toEqual([{ set: { [SCALE]: 0.1 } }]);
});

it("begins afresh with the turned variance only after the board has answered", async () => {
  const { board, user, type } = await mountLabs();
  await type("0.1");
  await user.click(screen.getByRole("button", { name: "Count afresh" }));
  expect(board.commands).toHaveLength(1);
  board.status({ parameters: withScale(0.1) });
  await board.reply();
  expect(board.commands[1]).toEqual({
    kind: "reset",
    values: {
      "sensor.noise_um": 0.05,
      "plant.drive_noise_v": 0.01,
      "reference.amplitude_v": 10,
      "reference.frequency_hz": 2000,
      [SCALE]: 0.1,
      "diagnosers.kalman.process_noise_v": expect.any(Number),
      "diagnosers.kalman.probability_floor": expect.any(Number),
    },
  });
});

it("offers the way back to the variance that the bench had", async () => {
  const { board, user } = await mountLabs();
  await variance();
  board.status({ parameters: withScale(0.1) });
  expect(await variance()).toHaveValue("0.1");
  await user.click(screen.getByRole("button", { name: "Assumed variance over true: back to 1" }));
  expect(board.commands).toEqual([{ set: { [SCALE]: 1 } }]);
});

it("shows what the assumptions cost, and marks residuals far from 1", async () => {
  const { board } = await mountLabs();
  const cost = async (name: string) => (await screen.findByText(name, { selector: "dt" })).nextElementSibling;
  expect(await cost("correct")).toHaveTextContent("97.75 %");
  expect(await cost("mean delay")).toHaveTextContent("300 µs"); // without the start-up
  expect(await cost("false switches")).toHaveTextContent("0");
  expect(await cost("residuals against assumed")).toHaveTextContent(/^0\.97/);
  expect(await cost("residuals against assumed")).toHaveAttribute("data-off", "false");
  const { kalman } = status.scores;
  board.status({ scores: { kalman: { ...kalman, nis: 9.66, delays: [] } } });
  expect(await cost("residuals against assumed")).toHaveTextContent(/^9\.66/);
  expect(await cost("residuals against assumed")).toHaveAttribute("data-off", "true");
  expect(await cost("mean delay")).toHaveTextContent("–");
});

it("refuses a variance out of its range in words, and sends nothing", async () => {
  const { board, type } = await mountLabs();
  await type("-1");
  expect(screen.getByRole("alert")).toHaveTextContent(/^at least/);
  expect(await variance()).toBeInvalid();
  expect(board.commands).toEqual([]);
});

it("shows the words of a refusal, and sends nothing for a watcher", async () => {
  const { board, type } = await mountLabs();
  await type("0.1");
  await board.refuse("The bench replays a recording.");
  expect(screen.getByRole("alert")).toHaveTextContent("The bench replays a recording.");
  be("watcher");
  await type("0.2");
  expect(board.commands).toHaveLength(1);
});

it("says how long a forgetting factor remembers", async () => {
  const diagnosers = {
    kalman: { ...(bench.parameters.diagnosers as Record<string, object>).kalman, kind: "rls_bank" },
  };
  const forgetful = catalog.blocks.find(
    (b) => b.family === "diagnose" && b.parameters.some((p) => p.name === "forgetting"),
  );
  diagnosers.kalman.kind = forgetful?.name as string;
  connect({ ...bench, parameters: { ...bench.parameters, diagnosers } });
  mount(<LabsPanel />);
  const lab = await screen.findByRole("region", { name: "Memory" });
  expect(lab).toHaveTextContent(/remembers (everything|[\d.]+\ssamples)/);
});

it("says that a bench has no diagnoser", () => {
  connect({ ...bench, diagnosers: {} });
  mount(<LabsPanel />);
  expect(screen.getByText(words("No diagnoser on this bench"))).toBeVisible();
});
