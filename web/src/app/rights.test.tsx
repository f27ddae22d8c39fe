import { act, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useMe } from "../api/me";
import type { ViewName } from "../bench/panel-views";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { resize } from "../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { Header } from "./header/header";
import { PanelBody } from "./panel-body";
import { VIEW } from "./panels";
import { Rail } from "./rail";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const company = {
  is_leased: false,
  driver: null,
  drivers: [],
  asking: [],
  lent_by: "",
  watching: [],
  more_watching: 0,
  links: 0,
};

beforeEach(() => {
  window.innerWidth = 2000;
  resize(2000, 900);
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/classes", { classes: [] });
});

const DRIVES = ["Pause", "Step one tick", "Step one period", "Reset", "÷2: half as fast", "×2: twice as fast"];
const TEACHES = [/^Fork/, /^Keep this moment/, /^Share/];

function mountHeader(role: "teacher" | "student" | "watcher") {
  be(role, { bench: bench.id, class_name: "Tuesday" });
  connect({ ...bench, state: "running", company } as typeof bench);
  mount(<Header />);
}

it("gives a teacher every button", () => {
  mountHeader("teacher");
  for (const name of [...DRIVES, ...TEACHES, /^Undo/, /^Redo/, /^Record/, /^Save/, /^Keyboard/])
    expect(screen.getByRole("button", { name })).toBeVisible();
});

it("gives a student what drives, and nothing that a teacher alone may use", () => {
  mountHeader("student");
  for (const name of [...DRIVES, /^Undo/, /^Redo/, /^Record/])
    expect(screen.getByRole("button", { name })).toBeVisible();
  for (const name of TEACHES) expect(screen.queryByRole("button", { name })).not.toBeInTheDocument();
});

it("gives a watcher nothing that changes the bench", () => {
  mountHeader("watcher");
  for (const name of [...DRIVES, ...TEACHES, /^Undo/, /^Redo/, /^Record/])
    expect(screen.queryByRole("button", { name })).not.toBeInTheDocument();
  expect(screen.getByText("You watch this bench")).toBeVisible();
  for (const box of screen.getAllByRole("combobox")) expect(box).toBeDisabled();
});

it("gives a student who looks at a bench that is shown to all nothing that changes it", async () => {
  mountHeader("student");
  be("student", { bench: "own", shown: bench.id });
  act(() => useMe.setState({ at: bench.id }));
  await waitFor(() => expect(screen.queryByRole("button", { name: "Pause" })).not.toBeInTheDocument());
  expect(screen.queryByRole("button", { name: /^Undo/ })).not.toBeInTheDocument();
});

it.each([
  ["teacher", ["Search", "Bench", "Class", "Gallery", "Runs", "Scores", "Design", "Theory"]],
  ["student", ["Search", "Bench", "Gallery", "Scores", "Design", "Theory"]],
  ["watcher", ["Search", "Bench", "Gallery", "Scores", "Design", "Theory"]],
] as const)("offers a %s the pages there are for them", (role, names) => {
  be(role);
  mount(<Rail />);
  expect(screen.getAllByRole("button").map((button) => button.textContent)).toEqual(names);
  expect(screen.getByRole("button", { current: "page" })).toHaveTextContent("Bench");
});

it("goes to a page that is pressed", async () => {
  const { user } = mount(<Rail />);
  await user.click(screen.getByRole("button", { name: "Runs" }));
  expect(window.location.pathname).toBe("/runs");
  expect(screen.getByRole("button", { current: "page" })).toHaveTextContent("Runs");
});

/** Views that change the bench. */
const changing = Object.entries(VIEW).filter(([, kind]) => kind.changes);

it("has these views that change the bench, and these that show no more than is served while a fault is hidden", () => {
  expect(changing.map(([name]) => name).join(" ")).toBe(
    "device sensor environment board controllers parameters sets faults identify hypotheses labs twins sheet blind games",
  );
  const served = Object.entries(VIEW).filter(([, kind]) => kind.whileBlind);
  expect(served.map(([name]) => name).join(" ")).toBe(
    "controllers time spectrum lanes narrator events sheet vote blind games",
  );
});

it.each(changing)("has no view %s for a watcher", (view, kind) => {
  be("watcher");
  connect(kind.only === "axes" ? ({ ...bench, axes: ["x", "y"] } as typeof bench) : bench);
  mount(<PanelBody view={view as ViewName} params={{}} setParams={() => undefined} />);
  expect(screen.getByText(/You watch this bench/)).toBeVisible();
  expect(screen.queryByRole("button")).not.toBeInTheDocument();
});

it.each(
  Object.entries(VIEW).filter(([, kind]) => !kind.whileBlind),
)("hides the view %s while a fault is hidden, and while a game is played", (view, kind) => {
  const shown = { ...bench, axes: kind.only === "axes" ? ["x", "y"] : [], diagnosers: {}, faults: [], events: [] };
  const question = { id: "q", answers: ["healthy", "m+5"], factors: [], shows: [], began_tick: 0, by_tick: 100 };
  const board = connect({ ...shown, blind: question } as never);
  mount(<PanelBody view={view as ViewName} params={{}} setParams={() => undefined} />);
  expect(screen.getByText("Hidden while you look for the fault")).toBeVisible();
  board.status({ blind: { ...question, game: { game: "g", seed: 1 } } } as never);
  expect(screen.getByText("Hidden while the game is played")).toBeVisible();
  expect(server.requests).toEqual([]);
});

it.each(changing)("has no view %s on a bench that plays a recording", (view, kind) => {
  connect({ ...bench, replay_of: "rec", axes: kind.only === "axes" ? ["x", "y"] : [] } as typeof bench);
  mount(<PanelBody view={view as ViewName} params={{}} setParams={() => undefined} />);
  expect(screen.getByText("The past cannot be changed")).toBeVisible();
});
