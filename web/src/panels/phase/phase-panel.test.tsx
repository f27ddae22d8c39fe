import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce, resize } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { be, mount } from "../../testing/render";
import { CANVAS } from "../../ui/palette";
import { PhasePanel } from "./phase-panel";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const region = await recordedAnswer("unstable-region");
const planar = { ...bench, parameters: { ...bench.parameters, plant: { model: "planar" } } };
const ORBIT = {
  "plant.displacement": (tick: number) => 2 * Math.sin(tick / 8),
  "plant.velocity": (tick: number) => 25 * Math.cos(tick / 8),
};

beforeEach(() => server.on("GET", "/benches/:id/unstable-region", region));

function mountPanel(of = bench) {
  const board = connect(of);
  return { board, ...mount(<PhasePanel />), pen: () => penOf(screen.getByRole("img")) };
}

it("subscribes to every tick of displacement and velocity, and draws nothing before they come", async () => {
  const { board, pen } = mountPanel();
  expect(board.subscriptions).toEqual([
    { mode: "roll", signals: ["plant.displacement", "plant.velocity"], window_ms: 4, width: 400 },
  ]);
  board.frame(ORBIT, { head: 500 });
  await drawOnce();
  const before = pen().lines().length;
  expect(before).toBeGreaterThan(10);
});

it("names both axes with their units", async () => {
  const { board, pen } = mountPanel();
  board.frame(ORBIT, { head: 500 });
  await drawOnce();
  expect(pen().words).toEqual(expect.arrayContaining(["plant displacement, µm", "plant velocity, mm/s"]));
  board.frame({ ...ORBIT, "plant.displacement": (tick) => 2e-3 * Math.sin(tick / 8) }, { head: 500 });
  for (let i = 0; i < 400; i += 1) {
    board.frame({ ...ORBIT, "plant.displacement": (tick) => 2e-3 * Math.sin(tick / 8) }, { head: 500 });
    await drawOnce();
  }
  expect(pen().words).toContain("plant displacement, nm");
});

it.each([
  [600, 300],
  [300, 600],
])("draws a square field in a place of %d by %d", async (width, height) => {
  const { board, pen } = mountPanel();
  resize(width, height);
  board.frame(ORBIT, { head: 500 });
  await drawOnce();
  const trail = pen()
    .lines()
    .flatMap(({ points, alpha }) => (alpha < 1 ? points : []));
  const [xs, ys] = [trail.map(([x]) => x), trail.map(([, y]) => y)];
  const [across, up] = [xs, ys].map((all) => Math.max(...all) - Math.min(...all));
  expect(across / up).toBeCloseTo(1, 1);
});

it("draws the trail anew with each frame", async () => {
  const { board, pen } = mountPanel();
  board.frame(ORBIT, { head: 500 });
  await drawOnce();
  const before = pen().areas().at(-1)?.points;
  board.frame(ORBIT, { head: 507 });
  await drawOnce();
  expect(pen().areas().at(-1)?.points).not.toEqual(before);
});

it("has no unstable region under a linear plant, and offers the planar one", async () => {
  const { board, user } = mountPanel();
  expect(screen.getByText(/^No unstable region: the linear plant/)).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Use the planar plant" }));
  expect(board.commands).toEqual([{ set: { "plant.model": "planar" } }]);
});

it("offers no other plant to a watcher", () => {
  be("watcher");
  mountPanel();
  expect(screen.queryByRole("button", { name: "Use the planar plant" })).not.toBeInTheDocument();
});

it("draws the unstable region of a planar plant beneath the trail, and says where it folds", async () => {
  const { board, user, pen } = mountPanel(planar);
  expect(screen.getByText("Working out the unstable region.")).toBeVisible();
  expect(await screen.findByText(/a slow drive folds at 5\.24\sµm and 44\.2\sV/)).toBeVisible();
  board.frame(ORBIT, { head: 500 });
  await drawOnce();
  expect(screen.getByRole("img", { name: /over the map of the unstable region$/ })).toBeVisible();
  expect(pen().lines(CANVAS.dark.alarm)).toHaveLength(region.folds.length);
  await user.clear(screen.getByRole("textbox", { name: "Drive held, V" }));
  await user.type(screen.getByRole("textbox", { name: "Drive held, V" }), "12{Enter}");
  await waitFor(() =>
    expect(server.asked("GET", `/benches/${bench.id}/unstable-region`).map(({ query }) => query.drive_v)).toEqual([
      "0",
      "12",
    ]),
  );
});

it("has the unstable region over a displacement only", async () => {
  const { board, user } = mountPanel(planar);
  await screen.findByText(/a slow drive folds/);
  await user.selectOptions(screen.getByRole("combobox", { name: "Across" }), "drive.voltage");
  expect(screen.getByText(/is drawn over a displacement/)).toBeVisible();
  expect(board.subscriptions[0].signals).toEqual(["drive.voltage", "plant.velocity"]);
  expect(screen.getByRole("img")).toHaveAccessibleName("plant velocity over drive voltage");
  await user.selectOptions(screen.getByRole("combobox", { name: "Up" }), "drive.voltage");
  await user.selectOptions(screen.getByRole("combobox", { name: "Length of the trail" }), "10");
  expect(board.subscriptions[0]).toEqual({ mode: "roll", signals: ["drive.voltage"], window_ms: 10, width: 1000 });
});

it("says why there is no map", async () => {
  server.on("GET", "/benches/:id/unstable-region", new Refusal(422, "The device has no comb."));
  mountPanel(planar);
  expect(await screen.findByText(/The device has no comb/)).toBeVisible();
});

it("shows a gyroscope the turn of its mass", async () => {
  const { board } = mountPanel(gyroscope.bench);
  expect(board.subscriptions[0].signals).toEqual(["plant.x", "plant.x_velocity"]);
  expect(screen.getByText(/^Rotation of the moving mass/)).toBeVisible();
});
