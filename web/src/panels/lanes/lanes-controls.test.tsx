import { act, screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useView } from "../../bench/view-store";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { be, mount } from "../../testing/render";
import { besideEstimate, withWeighted } from "../../testing/weighted";
import { LanesPanel } from "./lanes-panel";

const { bench, status, events, frames } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const { kalman } = bench.diagnosers;
const score = status.scores.kalman;

/** The bench with a second bank beside the first. */
const rivals = {
  ...bench,
  diagnosers: { kalman, second: { ...kalman, kind: "imm" } },
  signals: [
    ...bench.signals,
    ...bench.signals.flatMap((s) =>
      s.block === "kalman" ? { ...s, name: s.name.replace("kalman", "second"), block: "second" } : [],
    ),
    ...bench.signals.flatMap((s) =>
      s.name.startsWith("kalman.") && s.block !== "kalman" ? { ...s, name: s.name.replace("kalman", "second") } : [],
    ),
  ],
};

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("POST", "/benches/:id/variant", { ...bench, id: "next" });
});

const figure = (name: string) => screen.getByText(name, { selector: "dt" }).nextElementSibling;

it("says the verdict in words, and how often it was right", () => {
  const board = connect(bench);
  board.status(status);
  mount(<LanesPanel />);
  const verdict = screen.getByTitle("m+5");
  expect(verdict).toHaveTextContent(/^mass \+5\s%$/);
  expect(verdict).toHaveAttribute("data-right", "true");
  expect(figure("correct")).toHaveTextContent("97.8 %");
  expect(figure("false switches")).toHaveTextContent("0");
  board.status({ scores: { kalman: { ...score, winner: 3, false_switches: 2 } } });
  expect(screen.getByTitle("k+5")).toHaveAttribute("data-right", "false");
  expect(figure("false switches")).toHaveTextContent("2");
});

it("says the weighted output with its standard deviation, where the bench has it", async () => {
  const board = connect(withWeighted(bench));
  board.status(status);
  mount(<LanesPanel />);
  board.frame(
    { "kalman.weighted.displacement": () => -2.5, "kalman.weighted.displacement_std": () => 0.02 },
    { head: 400 },
  );
  await drawOnce();
  expect(figure("weighted output")?.textContent?.replace(/\s/g, " ")).toBe("−2.50 µm ± 20.0 nm");
});

it("calls the delay before any fault a start-up", async () => {
  const board = connect(bench);
  board.status(status);
  mount(<LanesPanel />);
  const fault = events.findIndex(({ kind }) => kind === "inject");
  await board.events(events.slice(0, fault));
  expect(figure("start-up")).toHaveTextContent(/^260\sµs$/);
  await board.events(events.slice(fault));
  expect(figure("delay")).toHaveTextContent(/^30\ssamples · 300\sµs$/);
  expect(screen.queryByText("start-up")).not.toBeInTheDocument();
});

it("says when the last false switches were, and how long each lasted", () => {
  const board = connect(bench);
  const last_false_switches = [
    { tick: 400, samples: 3 },
    { tick: 1250, samples: 1 },
  ];
  board.status({ ...status, scores: { kalman: { ...score, false_switches: 5, last_false_switches } } });
  mount(<LanesPanel />);
  expect(figure("false switches")).toHaveTextContent(/^5last at 12\.500\sms, 1\ssample$/);
  expect(figure("false switches")?.firstElementChild?.getAttribute("title")?.replace(/\s/g, " ")).toBe(
    "The right verdict was left though nothing changed: 3 earlier " +
      "at 4.000 ms (tick 400) for 3 samples, 30.0 µs at 12.500 ms (tick 1250) for 1 sample, 10.0 µs",
  );
});

it("says by how much even the best hypothesis misses where none fits", async () => {
  const board = connect(bench);
  board.status({ ...status, scores: { kalman: { ...score, unexplained: true, least_nis: 9 } } });
  const { user } = mount(<LanesPanel />);
  await user.hover(screen.getByText("fits none"));
  expect(await screen.findByText(/misses by 3\.0 times what its filter expects/)).toBeVisible();
  expect(screen.getByTitle("m+5")).toHaveAttribute("data-right", "false");
});

it("says that the board has stopped instead of a verdict", () => {
  const board = connect(bench);
  board.status({ ...status, state: "tripped" });
  mount(<LanesPanel />);
  expect(screen.getByText("stopped")).toHaveAttribute("title", expect.stringContaining("mass +5"));
});

it("picks the sample that is clicked in the lanes", async () => {
  const board = connect(bench);
  board.status(status);
  const { container } = mount(<LanesPanel />);
  await board.events(events);
  board.replay(frames.kalman);
  await drawOnce();
  const field = container.querySelector("canvas ~ div:last-of-type") as HTMLElement;
  for (const type of ["pointerdown", "pointerup"]) {
    const event = new MouseEvent(type, { bubbles: true, button: 0 });
    Object.defineProperties(event, { pointerId: { value: 1 }, offsetX: { value: field.clientWidth / 2 } });
    act(() => void field.dispatchEvent(event));
  }
  const { sample } = useView.getState();
  expect(sample?.diagnoser).toBe("kalman");
  expect(sample?.tick).toBe(1800); // the middle of 400 ticks that end at 2000
});

it("subscribes to another window of time", async () => {
  const board = connect(bench);
  const { user } = mount(<LanesPanel />);
  await user.selectOptions(screen.getByRole("combobox", { name: "Time window" }), "100");
  expect(besideEstimate(board.subscriptions)[0]).toMatchObject({ window_ms: 100 });
});

it("shows the card of the diagnoser", async () => {
  connect(bench);
  const { user } = mount(<LanesPanel />);
  await user.click(screen.getByRole("button", { name: "kalman says" }));
  expect(useView.getState().card).toBe("diagnosers.kalman");
});

it("races several diagnosers under one truth, with their delays and places", async () => {
  const board = connect(rivals);
  board.status({ ...status, scores: { kalman: score, second: { ...score, correct_fraction: 0.5 } } });
  mount(<LanesPanel />);
  const late = events.map((event) => ({
    ...event,
    seq: event.seq + 10,
    text: event.text.replace("kalman", "second").replace(/30\s/, "45 "),
    old: event.kind === "recognised" ? Number(event.old) + 15 : event.old,
  }));
  await board.events([...events, ...late]);
  const row = (id: string) => screen.getByRole("region", { name: `Diagnosis by ${id}` });
  expect(screen.getAllByRole("region", { name: /^Diagnosis by/ })).toHaveLength(2);
  expect(screen.getByRole("img", { name: "The truth over time" })).toBeVisible();
  const last = (id: string) => within(row(id)).getByText("last delay").nextElementSibling;
  expect(last("kalman")).toHaveTextContent("300 µs1st");
  expect(last("second")).toHaveTextContent("450 µs2nd");
  expect(row("second")).toHaveTextContent("50.0 %");
  const mean = within(row("kalman")).getByText("mean delay").nextElementSibling;
  expect(mean).toHaveTextContent("300 µs"); // of 30 samples; those before them are the start-up
});

it("shows one of several diagnosers in full", async () => {
  const board = connect(rivals);
  const { user } = mount(<LanesPanel />);
  expect(besideEstimate(board.subscriptions)).toHaveLength(3);
  await user.selectOptions(screen.getByRole("combobox", { name: "Diagnosers shown" }), "second");
  expect(besideEstimate(board.subscriptions)).toHaveLength(1);
  expect(besideEstimate(board.subscriptions)[0].signals).toContain("second.probability.healthy");
  expect(screen.getByRole("img", { name: /^Probability of/ })).toBeVisible();
});

it("begins again with a diagnoser that the bench has not, for who teaches", async () => {
  connect({ ...bench, diagnosers: {} });
  const { user, unmount } = mount(<LanesPanel />);
  await user.selectOptions(await screen.findByRole("combobox", { name: "Diagnoser to add" }), "imm");
  await user.click(screen.getByRole("button", { name: "Restart with it" }));
  await waitFor(() => expect(server.asked("POST", "/benches/first-look/variant")).toHaveLength(1));
  expect(server.asked("POST", "/benches/first-look/variant")[0].body).toEqual({
    set: { "diagnosers.imm": { kind: "imm" } },
    repeat: false,
  });
  unmount();
  be("student");
  mount(<LanesPanel />);
  expect(screen.queryByRole("button", { name: "Restart with it" })).not.toBeInTheDocument();
});

it("has no truth while a fault is to be found", async () => {
  const hidden = bench.signals.filter(({ name }) => !/^kalman\.(truth|unexplained)$/.test(name));
  const board = connect({ ...bench, signals: hidden, blind: { id: "b" } as never });
  mount(<LanesPanel />);
  expect(besideEstimate(board.subscriptions)[0].signals).not.toContain("kalman.truth");
  expect(screen.queryByText("delay", { selector: "dt" })).not.toBeInTheDocument();
  const values = Object.fromEntries(kalman.names.map((name) => [`kalman.probability.${name}`, () => 0.1]));
  board.frame({ ...values, "kalman.winner": () => 0 }, { head: 2000 });
  await drawOnce();
  expect(penOf(screen.getByRole("img")).words).not.toContain("truth");
});
