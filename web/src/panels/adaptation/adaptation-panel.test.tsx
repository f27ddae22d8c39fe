import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { be, mount } from "../../testing/render";
import { AdaptationPanel } from "./adaptation-panel";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const MONITOR = ["excitation_relative", "excitation", "identifiable"].map((port) => ({
  ...bench.signals[0],
  name: `excitation.${port}`,
  block: "excitation",
  unit: "1",
}));

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("POST", "/benches/:id/variant", { ...bench, id: "next" });
});

async function mountPanel(of = bench) {
  const board = connect(of);
  const { user } = mount(<AdaptationPanel />);
  const adapts = screen.getByRole("combobox", { name: "What adapts" });
  return { board, user, adapts };
}

it("draws the gains of a controller beside their ideal values, V and the errors, with their units", async () => {
  const { board, user, adapts } = await mountPanel();
  await user.selectOptions(adapts, "mrac");
  const plot = screen.getByRole("img", { name: /^mrac: gain r, .*V, dV\/dt by theory, error, augmented error/ });
  const [{ signals }] = board.subscriptions;
  expect(signals).toEqual(
    expect.arrayContaining(["mrac.gain.r", "mrac.gain_ideal.r", "mrac.lyapunov", "mrac.lyapunov_rate"]),
  );
  const still = Object.fromEntries(signals.map((name) => [name, () => 1.5]));
  board.frame(still, { head: 3000 });
  await drawOnce();
  expect(penOf(plot).words).toEqual(expect.arrayContaining(["gain r", "V"]));
  const before = penOf(plot)
    .lines()
    .map(({ points }) => points);
  board.frame({ ...still, "mrac.gain.r": (tick) => Math.sin(tick / 50) }, { head: 3100 });
  await drawOnce();
  expect(
    penOf(plot)
      .lines()
      .map(({ points }) => points),
  ).not.toEqual(before);
});

it("gives a controller in shadow the drive, and says that it drives", async () => {
  const { board, user, adapts } = await mountPanel();
  await user.selectOptions(adapts, "mrac");
  expect(screen.getByText(/^mrac runs in shadow/)).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Give it the drive" }));
  expect(board.commands).toEqual([{ switch: "mrac", cold: false }]);
  board.status({ controller: "mrac", slots: { "": "mrac" } });
  expect(screen.queryByText(/runs in shadow/)).not.toBeInTheDocument();
  expect(screen.getByRole("option", { name: "mrac, drives" })).toBeInTheDocument();
});

it("begins again with an excitation monitor", async () => {
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Restart with an excitation monitor" }));
  await waitFor(() => expect(server.asked("POST", "/benches/first-look/variant")).toHaveLength(1));
  expect(server.asked("POST", "/benches/first-look/variant")[0].body).toEqual({
    set: { "identifiers.excitation": { kind: "excitation" } },
    repeat: false,
  });
  await waitFor(() => expect(window.location.search).toContain("bench=next"));
});

it("says why a bench cannot begin again", async () => {
  server.on("POST", "/benches/:id/variant", new Refusal(409, "There is no room for another bench."));
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Restart with an excitation monitor" }));
  expect(await screen.findByText("There is no room for another bench.")).toBeVisible();
});

it.each([
  [1, 0.02, /^20\.?0?\sm?: identifies all parameters|^0\.020: identifies all parameters/],
  [0, 1e-7, /this input cannot identify the parameters$/],
])("says how much the input tells: identifiable %d", async (identifiable, relative, said) => {
  const { board } = await mountPanel({ ...bench, signals: [...bench.signals, ...MONITOR] });
  board.frame(
    {
      "excitation.excitation_relative": () => relative,
      "excitation.excitation": () => 1,
      "excitation.identifiable": () => identifiable,
    },
    { head: 3000 },
  );
  await drawOnce();
  expect(screen.getByText("Excitation").parentElement?.querySelector("b")).toHaveTextContent(said);
});

it("offers no drive to a watcher and no other bench to a student", async () => {
  be("student");
  await mountPanel();
  expect(screen.queryByRole("button", { name: /^Begin again/ })).not.toBeInTheDocument();
  expect(screen.getByRole("button", { name: "Give it the drive" })).toBeVisible();
});

it("says that nothing adapts on a bench", () => {
  connect({ ...bench, signals: bench.signals.slice(0, 2) });
  mount(<AdaptationPanel />);
  expect(screen.getByText("Nothing adapts on this bench")).toBeVisible();
});
