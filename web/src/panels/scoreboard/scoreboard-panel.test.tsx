import { screen, within } from "@testing-library/react";
import { expect, it } from "vitest";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { withWeighted } from "../../testing/weighted";
import { ScoreboardPanel } from "./scoreboard-panel";

const { bench, status } = await recordedBench("first-look");
const { kalman } = status.scores;
const weighing = withWeighted(bench);
const cells = (name: string) =>
  within(within(screen.getAllByRole("table")[0]).getByRole("row", { name: new RegExp(`^${name} `) }))
    .getAllByRole("cell")
    .map((cell) => cell.textContent?.replace(/\s/g, " "));

it("shows each diagnoser with its delays in samples and in time", () => {
  const board = connect(bench);
  mount(<ScoreboardPanel />);
  const slow = { ...kalman, correct_fraction: 0.5, delays: [null, null, 10], false_switches: 3 };
  board.status({ scores: { kalman, slow_one: slow, none_found: { ...kalman, delays: [null] } } });
  expect(cells("kalman")).toEqual(["97.75 %", "30.0samples, 300 µsstart-up 260 µs", "0 of 2", "0"]);
  expect(cells("slow one")).toEqual(["50.00 %", "10.0samples, 100 µs", "2 of 3", "3"]);
  expect(cells("none found")).toEqual(["97.75 %", "–", "1 of 1", "0"]);
});

it("says when a diagnoser last left the right verdict, and for how long", () => {
  const board = connect(bench);
  mount(<ScoreboardPanel />);
  const last_false_switches = [{ tick: 400, samples: 3 }];
  board.status({ scores: { kalman: { ...kalman, false_switches: 1, last_false_switches } } });
  expect(cells("kalman")[3]).toBe("1last at 4.000 ms, 3 samples");
});

it("shows the new score when it comes", () => {
  const board = connect(bench);
  board.status(status);
  mount(<ScoreboardPanel />);
  board.status({ scores: { kalman: { ...kalman, correct_fraction: 0.25 } } });
  expect(cells("kalman")[0]).toBe("25.00 %");
});

it("says that there is no score yet", () => {
  connect(bench);
  mount(<ScoreboardPanel />);
  expect(screen.getByText("No score")).toBeVisible();
});

it("is a region that keys reach, for it scrolls", async () => {
  const board = connect(bench);
  const { user } = mount(<ScoreboardPanel />);
  board.status(status);
  await user.tab();
  expect(screen.getByRole("region", { name: "Scoreboard" })).toHaveFocus();
});

it("shows state and parameters as the probabilities weigh them, with standard deviations", async () => {
  const board = connect(weighing);
  board.status(status);
  mount(<ScoreboardPanel />);
  const weighted = (values: Record<string, number>) =>
    Object.fromEntries(Object.entries(values).map(([port, value]) => [`kalman.weighted.${port}`, () => value]));
  board.frame(
    weighted({
      displacement: 1.5,
      displacement_std: 0.014,
      velocity: -20,
      velocity_std: 0.25,
      mass: 1.0496,
      stiffness: 1,
      damping: 1.003,
    }),
    { head: 400 },
  );
  await drawOnce();
  const table = screen.getByRole("table", { name: /^Models weighted by their probabilities/ });
  const shown = within(within(table).getByRole("row", { name: /^kalman / })).getAllByRole("cell");
  expect(shown.map((cell) => cell.textContent?.replace(/\s/g, " "))).toEqual([
    "1.50 µm± 14.0 nm",
    "−20.0 mm/s± 250 µm/s",
    "× 1.050",
    "× 1.000",
    "× 1.003",
  ]);
});

it("shows motion, rate and parameters of a device with two axes", async () => {
  const values: Record<string, [string, number]> = {
    x: ["um", 0.5],
    x_std: ["um", 1e-6],
    y: ["um", 0.01],
    y_std: ["um", 2e-6],
    rate: ["deg/s", 300],
    rate_std: ["deg/s", 1.5],
    mass: ["1", 1],
    stiffness: ["1", 1],
    damping: ["1", 2],
    second_stiffness: ["1", 1.01],
    quadrature: ["deg/s", 500],
  };
  const place = { block: "kalman.weighted", kind: "tap" as const, meaning: "" };
  const own = Object.entries(values).map(([port, [unit]], index) => ({
    name: `kalman.weighted.${port}`,
    unit,
    index: index + 1000,
    ...place,
  }));
  const board = connect({
    ...bench,
    signals: [...bench.signals.filter(({ name }) => !name.includes(".weighted.")), ...own],
  });
  board.status(status);
  mount(<ScoreboardPanel />);
  board.frame(
    Object.fromEntries(Object.entries(values).map(([port, [, value]]) => [`kalman.weighted.${port}`, () => value])),
    { head: 400 },
  );
  await drawOnce();
  const table = screen.getByRole("table", { name: /^Models weighted by their probabilities/ });
  expect(
    within(table)
      .getAllByRole("columnheader")
      .map((head) => head.textContent),
  ).toEqual(["Diagnoser", "x", "y", "Rate", "Mass", "Stiffness", "Damping", "Stiffness of y", "Quadrature"]);
  const shown = within(within(table).getByRole("row", { name: /^kalman / })).getAllByRole("cell");
  expect(shown.map((cell) => cell.textContent?.replace(/\s/g, " "))).toEqual([
    "500 nm± 1.00 pm",
    "10.0 nm± 2.00 pm",
    "300 deg/s± 1.50 deg/s",
    "× 1.000",
    "× 1.000",
    "× 2.000",
    "× 1.010",
    "500 deg/s",
  ]);
});

it("has no weighted estimates on a bench that does not show them", () => {
  const board = connect({ ...bench, signals: bench.signals.filter(({ name }) => !name.includes(".weighted.")) });
  board.status(status);
  mount(<ScoreboardPanel />);
  expect(screen.queryByRole("table", { name: /^Models weighted/ })).toBeNull();
});
