import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { useView } from "../../bench/view-store";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { SchematicPanel } from "./schematic-panel";

const { bench, status } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");

beforeEach(() => server.on("GET", "/catalog", catalog));

async function mountPanel(of = bench) {
  const board = connect(of);
  const { user } = mount(<SchematicPanel />);
  const drawing = screen.getByRole("combobox", { name: "Drawing" });
  const inside = async (id: string) => {
    await within(drawing).findByRole("option", { name: "Controller: PID" });
    await user.selectOptions(drawing, id);
    return within(screen.getByRole("group", { name: /^Stages of/ }));
  };
  return { board, user, drawing, inside };
}

/** A bench on which another controller drives. */
const driving = (controller: string, rest: object = {}) => ({
  ...bench,
  controller,
  slots: { "": controller },
  ...rest,
});
const loop = () => screen.getByRole("group", { name: /^Signal flow from the reference/ });
const box = (title: RegExp) => within(loop()).getByText(title, { selector: "title" }).parentElement as HTMLElement;

it.each([
  ["mrac", "3.1.2.1.1", [/^Adaptation gains, by ε/, /^Augmentation error η/]],
  ["mrac_velocity", "2.2.1", [/^Adaptation gains, by e:/]],
  ["indirect_mrac", "3.3.2.1", [/^Identifier Least squares/, /^Gain design/]],
  ["stvsc", "2.2.3.1", [/^Identifier Gradient/]],
])("draws the loop of %s as in figure %s", async (controller, figure, parts) => {
  await mountPanel(driving(controller));
  expect(loop()).toHaveAccessibleName(`Signal flow from the reference around the loop, as in figure ${figure}`);
  expect(screen.getByText(`drawn as figure ${figure}`, { exact: false })).toBeVisible();
  for (const part of parts) expect(box(part)).toBeInTheDocument();
});

it("draws a single beam as in figure 3.2.6.1", async () => {
  await mountPanel({ ...bench, parameters: { ...bench.parameters, sensor: { kind: "single_beam" } } });
  for (const part of [/^Light Through wafer/, /^Photodiode/, /^Recovery unit/, /^Device, grating/])
    expect(box(part)).toBeInTheDocument();
  expect(loop()).toHaveAccessibleName(/as in figure 3\.2\.6\.1$/);
});

it("draws the plain loop for another controller, and the figure when the controller changes", async () => {
  const { board } = await mountPanel(driving("pid"));
  expect(loop()).toHaveAccessibleName("Signal flow from the reference around the loop");
  board.status({ controller: "mrac", slots: { "": "mrac" } });
  expect(loop()).toHaveAccessibleName(/as in figure 3\.1\.2\.1\.1$/);
});

it("shows the card of a box on Enter and on a click", async () => {
  const { user } = await mountPanel(driving("mrac"));
  box(/^Augmentation/).focus();
  await user.keyboard("{Enter}");
  expect(useView.getState().card).toBe("controllers.mrac");
  await user.click(box(/^Sensor .*: show/));
  expect(useView.getState().card).toBe("sensor");
  expect(box(/^Sensor .*: show/)).toHaveAttribute("data-chosen", "true");
});

it("shows the newest values with their units, and the verdict in words", async () => {
  const { board } = await mountPanel();
  board.status(status);
  board.frame({ "reference.voltage": () => 7.25, "plant.displacement": () => -1.5 }, { head: 2000 });
  await drawOnce();
  const texts = [...loop().querySelectorAll("text")].map((one) => one.textContent);
  expect(texts).toEqual(
    expect.arrayContaining([
      expect.stringMatching(/^7\.25\sV$/),
      expect.stringMatching(/^−1\.50\sµm$/),
      expect.stringMatching(/^mass \+5\s%$/),
    ]),
  );
});

it("says nothing of a value before the first sample: that is not a value that is not finite", async () => {
  const { board } = await mountPanel();
  board.frame({ "reference.voltage": () => 7.25 }, { head: 0 });
  await drawOnce();
  const texts = [...loop().querySelectorAll("text")].map((one) => one.textContent);
  expect(texts).toContain("–");
  expect(texts).not.toContain("not finite");
});

it("marks the box a fault is seen on, and names the fault", async () => {
  const { board } = await mountPanel();
  await within(loop()).findByText("Added mass", { selector: "text" });
  expect(box(/^Device .*: show/)).toHaveAttribute("data-faulty", "true");
  expect(box(/^Sensor .*: show/)).toHaveAttribute("data-faulty", "false");
  board.status({ faults: [{ ...bench.faults[0], name: "sensor_bias" }] });
  expect(box(/^Sensor .*: show/)).toHaveAttribute("data-faulty", "true");
  expect(within(loop()).queryByText("Added mass", { selector: "text" })).not.toBeInTheDocument();
});

it("marks the drive and the sensor whose stages of the board act, and says how", async () => {
  const board = { delay_samples: 1, antialias_khz: 20 };
  await mountPanel({ ...bench, parameters: { ...bench.parameters, board } });
  expect(box(/^Drive Drive, arrives 1 sample late: show/i)).toHaveTextContent("late");
  expect(box(/^Sensor .*, behind a filter of 20 kHz: show/)).toHaveTextContent("filter");
});

it("draws the way of a supervisor to the controller it changes, and none of one that stops the board", async () => {
  const supervised = (kind: string) => ({ ...bench, parameters: { ...bench.parameters, supervisor: { kind } } });
  const { board } = await mountPanel(supervised("retuning"));
  const words = "The supervisor changes the controller by the verdict of the diagnosis";
  expect(within(loop()).getByText(words, { selector: "title" }).parentElement).toHaveTextContent(/acts$/);
  board.status({ parameters: supervised("shutdown").parameters });
  expect(within(loop()).queryByText(words)).not.toBeInTheDocument();
});

it("says the acronym of a controller whose name has no room", async () => {
  await mountPanel(driving("adrc"));
  expect(await within(loop()).findByText("ADRC")).toBeInTheDocument();
});

it("cuts a verdict that is longer than its box", async () => {
  const named = { ...bench.diagnosers.kalman, names: ["a damping that nothing explains"], factors: [{}] };
  const { board } = await mountPanel({ ...bench, diagnosers: { kalman: named } });
  board.status({ scores: { kalman: { ...status.scores.kalman, winner: 0 } } });
  expect(within(loop()).getByText("a damping that…")).toBeInTheDocument();
});

it("marks the stages of a gyroscope at both forces and both pick-offs", async () => {
  const { bench } = gyroscope;
  await mountPanel({ ...bench, parameters: { ...bench.parameters, board: { delay_fraction: 0.5, jitter_us: 0.1 } } });
  const boxes = within(screen.getByRole("group", { name: /^Signal flow around/ }));
  expect(boxes.getAllByText("late")).toHaveLength(2);
  expect(boxes.getAllByText("jitter")).toHaveLength(2);
});

it("names a fault below the drawing where the drawing has no room for it", async () => {
  await mountPanel(driving("mrac"));
  expect(await screen.findByText(/Added mass/, { selector: "p span" })).toBeVisible();
});

it("draws a controller from inside: its stages in order, with what flows between them", async () => {
  const { board, inside } = await mountPanel();
  const stages = await inside("controllers.mrac");
  expect(stages.getAllByRole("button").map((one) => one.textContent)).toEqual([
    "State filters",
    "Copies of the model",
    "Error",
    "Augmentation",
    "Augmented error",
    "Adaptation",
    "Law",
    "Lyapunov function",
  ]);
  board.frame({ "mrac.voltage": () => 2.5 }, { head: 2000 });
  await drawOnce();
  expect(stages.getByText(/^2\.50\sV$/)).toBeInTheDocument();
});

it("shows the equations of a stage on Enter, and hides them on the next", async () => {
  const { user, inside } = await mountPanel();
  const stages = await inside("controllers.mrac");
  stages.getByRole("button", { name: "Adaptation" }).focus();
  await user.keyboard("{Enter}");
  expect(screen.getByRole("region", { name: "Equations: Adaptation" })).toHaveTextContent("3.1.2.15-16");
  await user.keyboard("{Enter}");
  expect(screen.queryByRole("region", { name: /^Equations/ })).not.toBeInTheDocument();
  await user.click(stages.getByRole("button", { name: "Error" }));
  expect(screen.getByText("The text gives this stage no equation of its own.")).toBeVisible();
});

it("draws a bank from inside, its probabilities in percent", async () => {
  vi.useFakeTimers({ toFake: ["performance"] });
  const { board, user, inside } = await mountPanel();
  const stages = await inside("diagnosers.kalman");
  board.frame({ "kalman.probability.m+10": () => 0.125 }, { head: 2000 });
  vi.advanceTimersByTime(200);
  await drawOnce();
  expect(stages.getByText(/^12\.5\s%$/)).toBeInTheDocument();
  expect(stages.getAllByText("m+10", { ignore: "title" }).length).toBeGreaterThan(0);
  await user.click(stages.getByRole("button", { name: "Weights" }));
  expect(screen.getByRole("region", { name: "Equations: Weights" })).toHaveTextContent("5.2.3.2.6");
});

it.each([
  ["lqg", ["Kalman filter", "Law"], "estimate"],
  ["adrc", ["Extended state observer", "Law"], "disturbance"],
  ["h_infinity", ["Controller", "Law"], "error"],
  ["sliding_observer", ["Observer", "Law"], "velocity"],
])("draws %s from inside, with its own estimate and its voltage of now", async (name, titles, own) => {
  const { board, inside } = await mountPanel(driving(name));
  const stages = await inside(`controllers.${name}`);
  expect(stages.getAllByRole("button").map((one) => one.textContent)).toEqual(titles);
  board.frame({ [`${name}.voltage`]: () => 2.5, [`${name}.${own}`]: () => -1.25 }, { head: 2000 });
  await drawOnce();
  expect(stages.getByText(/^2\.50\sV$/)).toBeInTheDocument();
  expect(stages.getByText(/^−1\.25\s/)).toBeInTheDocument();
});

it("draws an extended Kalman filter from inside, as a diagnoser and as an identifier", async () => {
  const stiffness = { ...bench.signals[0], name: "ekf.stiffness", unit: "N/m", block: "ekf" };
  const estimate = { ...stiffness, name: "ekf.estimate.stiffness" };
  const { board, inside, user } = await mountPanel({
    ...bench,
    diagnosers: { ekf: { ...bench.diagnosers.kalman, kind: "ekf" } },
    signals: [...bench.signals, stiffness, estimate],
    parameters: {
      ...bench.parameters,
      diagnosers: { ekf: { kind: "ekf" } },
      identifiers: { ekf: { kind: "ekf" } },
    },
  });
  const bank = await inside("diagnosers.ekf");
  expect(bank.getAllByRole("button").map((one) => one.textContent)).toEqual([
    "Extended Kalman filter",
    "Distances",
    "Weights",
    "Test",
    "Verdict",
  ]);
  board.frame({ "ekf.stiffness": () => 2.5, "ekf.estimate.stiffness": () => 2.25 }, { head: 2000 });
  await drawOnce();
  expect(bank.getByText(/^2\.50\sN\/m$/)).toBeInTheDocument();
  await user.selectOptions(screen.getByRole("combobox", { name: "Drawing" }), "identifiers.ekf");
  const identifier = await screen.findByRole("group", { name: /^Stages of/ });
  expect(within(identifier).getByRole("button", { name: "Estimate" })).toBeInTheDocument();
});

it("draws a unit of one's own as one stage", async () => {
  const pid = catalog.blocks.find((b) => b.family === "control" && b.name === "pid");
  const [stage] = pid?.structure ?? [];
  const unit = { ...pid, name: "twice", title: "Twice", structure: [{ ...stage, title: "Twice" }] } as never;
  const { inside } = await mountPanel({ ...bench, controllers: [...bench.controllers, "twice"], units: [unit] });
  const stages = await inside("controllers.twice");
  expect(stages.getAllByRole("button").map((one) => one.textContent)).toEqual(["Twice"]);
});

it("draws both loops of a gyroscope, with the faulted box and the controllers of its slots", async () => {
  const { board } = await mountPanel(gyroscope.bench);
  const both = screen.getByRole("group", { name: "Signal flow around the drive loop and the sense loop" });
  expect(await within(both).findByText(/Adaptive rate|Adaptive/, { selector: "title" })).toBeInTheDocument();
  expect(both.querySelectorAll('[data-faulty="true"]').length).toBeGreaterThan(0);
  board.status({ slots: { drive: "drive_loop", sense: "force_to_rebalance" } });
  expect(both.querySelectorAll('[data-waits="true"]')).toHaveLength(0);
  board.status({ slots: { drive: "drive_loop", sense: "whole_angle" } });
  expect(both.querySelectorAll('[data-waits="true"]')).toHaveLength(1);
});
