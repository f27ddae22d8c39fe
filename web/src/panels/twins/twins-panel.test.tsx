import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { TwinsPanel } from "./twins-panel";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");
const ofTwin = (twin: string) =>
  bench.signals.map((s) => ({ ...s, name: `${twin}:${s.name}`, block: `${twin}:${s.block}` }));
const twins = {
  ...bench,
  parameters: {
    ...bench.parameters,
    twins: { mrac: { controller: { kind: "mrac" } }, stvsc: { controller: { kind: "stvsc" } } },
  },
  signals: [...bench.signals, ...ofTwin("mrac"), ...ofTwin("stvsc")],
};

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("POST", "/benches/:id/variant", { ...bench, id: "next" });
});

async function mountPanel(of = bench) {
  const board = connect(of);
  const { user } = mount(<TwinsPanel />);
  await screen.findAllByRole("option");
  return { board, user };
}
const twin = (number: number) => screen.getByRole("combobox", { name: `Controller of twin ${number}` });
const begun = async () => {
  await waitFor(() => expect(server.requests.filter(({ path }) => path.endsWith("/variant"))).toHaveLength(1));
  return server.requests.find(({ path }) => path.endsWith("/variant"))?.body;
};

it("begins again with the controllers that are chosen", async () => {
  const { user } = await mountPanel();
  expect(screen.getByText("No twins on this bench")).toBeVisible();
  await user.selectOptions(twin(1), "mrac");
  await user.selectOptions(twin(2), "stvsc");
  await user.click(screen.getByRole("button", { name: "Restart with these" }));
  expect(await begun()).toEqual({
    set: { twins: { mrac: { controller: { kind: "mrac" } }, stvsc: { controller: { kind: "stvsc" } } } },
    repeat: false,
  });
});

it("has three twins at the most", async () => {
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Twin" }));
  expect(twin(3)).toBeVisible();
  expect(screen.queryByRole("button", { name: "Twin" })).not.toBeInTheDocument();
});

it("compares every board by its error and its effort, with units, and marks the best", async () => {
  vi.useFakeTimers({ toFake: ["performance"] });
  const { board } = await mountPanel(twins);
  vi.advanceTimersByTime(600);
  const value = (name: string) => (tick: number) =>
    (name.startsWith("mrac:") ? 1.01 : name.startsWith("stvsc:") ? 1.2 : name.startsWith("plant") ? 1.5 : 1) *
    Math.sin(tick / 8);
  const signals = board.subscriptions.flatMap((one) => one.signals);
  board.frame(Object.fromEntries(signals.map((name) => [name, value(name)])), { head: 3000 });
  await drawOnce();
  expect(screen.getAllByRole("row")).toHaveLength(4);
  const row = (name: string) => within(screen.getByRole("row", { name: new RegExp(`^${name}`) })).getAllByRole("cell");
  const [error, , effort] = row("mrac");
  expect(error).toHaveTextContent(/^7\.\d+\snm$/);
  expect(error).toHaveAttribute("data-best", "true");
  expect(effort).toHaveTextContent(/\s?m?V$/);
  expect(row("this bench")[0]).toHaveTextContent(/^35\d\snm$/);
  expect(row("stvsc")[0]).toHaveAttribute("data-best", "false");
  expect(screen.getByText(/^Against the reference model, over the last/)).toBeVisible();
});

it("draws displacement and effort of all boards, then the gains of each", async () => {
  await mountPanel(twins);
  expect(
    screen.getByRole("img", { name: /^this bench, mrac, stvsc: displacement, effort, mrac: gain r/ }),
  ).toBeVisible();
});

it("begins again alone when every twin is left out", async () => {
  const { user } = await mountPanel(twins);
  await user.click(screen.getByRole("button", { name: "Leave out twin 2" }));
  expect(twin(1)).toHaveValue("mrac");
  await user.click(screen.getByRole("button", { name: "Leave out twin 1" }));
  await user.click(screen.getByRole("button", { name: "Restart without twins" }));
  expect(await begun()).toEqual({ set: { twins: {} }, repeat: false });
});

it("says why a bench cannot begin", async () => {
  server.on("POST", "/benches/:id/variant", new Refusal(409, "There is no room for another bench."));
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Restart with these" }));
  expect(await screen.findByText("There is no room for another bench.")).toBeVisible();
});

it("offers a gyroscope a controller for each of its slots", async () => {
  const { user } = await mountPanel({ ...gyroscope.bench, slots: { drive: "drive_loop", sense: "adaptive_rate" } });
  expect(twin(1)).toHaveValue("force_to_rebalance");
  expect(twin(2)).toHaveValue("open_loop_rate");
  await user.selectOptions(twin(2), "drive_tracking");
  await user.click(screen.getByRole("button", { name: "Restart with these" }));
  expect(await begun()).toMatchObject({
    set: {
      twins: {
        force_to_rebalance: { controller: { kind: "force_to_rebalance" } },
        drive_tracking: { slots: { drive: "drive_tracking" } },
      },
    },
  });
});

it("begins with the controllers of a gyroscope that are worth seeing and do not drive", async () => {
  await mountPanel({
    ...gyroscope.bench,
    controller: "open_loop_rate",
    slots: { drive: "drive_loop", sense: "open_loop_rate" },
  });
  expect([twin(1), twin(2)].map((one) => (one as HTMLSelectElement).value)).toEqual([
    "force_to_rebalance",
    "drive_tracking",
  ]);
});

it("compares gyroscopes by the rate in deg/s and the forces in N", async () => {
  vi.useFakeTimers({ toFake: ["performance"] });
  const signals = gyroscope.bench.signals.map((s) => ({
    ...s,
    name: `tracking:${s.name}`,
    block: `tracking:${s.block}`,
  }));
  const { board } = await mountPanel({
    ...gyroscope.bench,
    parameters: { ...gyroscope.bench.parameters, twins: { tracking: { slots: { drive: "drive_tracking" } } } },
    signals: [...gyroscope.bench.signals, ...signals],
  });
  vi.advanceTimersByTime(600);
  const asked = board.subscriptions.flatMap((one) => one.signals);
  board.frame(Object.fromEntries(asked.map((name, i) => [name, (tick: number) => (1 + i) * Math.sin(tick / 5)])), {
    head: 3000,
  });
  await drawOnce();
  expect(screen.getByRole("row", { name: /^tracking/ })).toHaveTextContent(/\d\sdeg\/s.*\d\s[nµm]?N/);
  expect(screen.getByRole("img", { name: /: rate, x, y, force along x, force along y/ })).toBeVisible();
});

it("offers twins to a teacher only", () => {
  be("student");
  connect(bench);
  mount(<TwinsPanel />);
  expect(screen.getByText(/^.*Only the teacher gives a bench twins/)).toBeVisible();
  expect(screen.queryByRole("button", { name: /^Begin/ })).not.toBeInTheDocument();
});
