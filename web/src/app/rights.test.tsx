import { act, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useMe } from "../api/me";
import type { ViewName } from "../bench/panel-views";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { Header } from "./header/header";
import { PanelBody } from "./panel-body";
import { servedIn, VIEW } from "./panels";
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
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/classes", { classes: [] });
  server.on("GET", "/devices", { devices: [], geometry: [] });
});

const DRIVES = ["Pause", "Step"];
const CHANGES = [/^Undo/, /^Redo/, /^Record/];
const TEACHES = [/^Fork/, /^Keep this moment/, /^Share/];

/** The header of a person, with its menu of all that is not about running. */
async function mountHeader(role: "teacher" | "student" | "watcher") {
  be(role, { bench: bench.id, class_name: "Tuesday" });
  connect({ ...bench, state: "running", company } as typeof bench);
  const { user } = mount(<Header />);
  await user.click(screen.getByRole("button", { name: "More" }));
  await screen.findByRole("menuitem", { name: /^Keyboard/ });
}

const items = (names: RegExp[]) => names.flatMap((name) => screen.queryAllByRole("menuitem", { name }));
const buttons = () => DRIVES.flatMap((name) => screen.queryAllByRole("button", { name }));

it("gives a teacher every button and every item", async () => {
  await mountHeader("teacher");
  expect(buttons()).toHaveLength(DRIVES.length);
  for (const name of [...CHANGES, ...TEACHES, /^Save this run/, /^Lab layout/, /^Present/])
    expect(screen.getByRole("menuitem", { name })).toBeVisible();
});

it("gives a student what drives, and nothing that a teacher alone may use", async () => {
  await mountHeader("student");
  expect(buttons()).toHaveLength(DRIVES.length);
  expect(items(CHANGES)).toHaveLength(CHANGES.length);
  expect(items(TEACHES)).toEqual([]);
});

it("gives a watcher nothing that changes the bench", async () => {
  await mountHeader("watcher");
  expect(buttons()).toEqual([]);
  expect(items([...CHANGES, ...TEACHES])).toEqual([]);
  expect(screen.getByText("You watch this bench")).toBeVisible();
  for (const box of screen.getAllByRole("combobox")) expect(box).toBeDisabled();
});

it("gives a student who looks at a bench that is shown to all nothing that changes it", async () => {
  await mountHeader("student");
  be("student", { bench: "own", shown: bench.id });
  act(() => useMe.setState({ at: bench.id }));
  await waitFor(() => expect(screen.queryByRole("button", { name: "Pause" })).not.toBeInTheDocument());
  expect(items(CHANGES)).toEqual([]);
});

it.each([
  ["teacher", ["Search", "Bench", "Class", "Gallery", "Runs", "Design", "Theory"]],
  ["student", ["Search", "Bench", "Gallery", "Runs", "Design", "Theory"]],
  ["watcher", ["Search", "Bench", "Gallery", "Runs", "Design", "Theory"]],
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
    "controllers time spectrum identify lanes narrator events sheet vote blind games",
  );
});

it.each(changing)("has no view %s for a watcher", (view, kind) => {
  be("watcher");
  connect(kind.only === "axes" ? ({ ...bench, axes: ["x", "y"] } as typeof bench) : bench);
  mount(<PanelBody view={view as ViewName} params={{}} setParams={() => undefined} />);
  expect(screen.getByText(/You watch this bench/)).toBeVisible();
  expect(screen.queryByRole("button")).not.toBeInTheDocument();
});

const question = {
  id: "q",
  game: null,
  answers: ["healthy", "m+5"],
  factors: [],
  shows: [],
  began_tick: 0,
  by_tick: 100,
};
const playing = { ...question, game: { game: "g", seed: 1 } };

it.each(
  Object.entries(VIEW).filter(([, kind]) => !servedIn(kind, question)),
)("hides the view %s while a fault is hidden, and while a game is played", (view, kind) => {
  const shown = { ...bench, axes: kind.only === "axes" ? ["x", "y"] : [], diagnosers: {}, faults: [], events: [] };
  const board = connect({ ...shown, blind: question } as never);
  mount(<PanelBody view={view as ViewName} params={{}} setParams={() => undefined} />);
  const hidden = screen.getByRole("region", { name: `${kind.title}, hidden` });
  expect(hidden).toBeVisible();
  expect(hidden).toHaveTextContent(`${kind.title}: hidden until you answer. Measure instead:`);
  board.status({ blind: playing } as never);
  expect(hidden).toHaveTextContent(`${kind.title}: hidden until the game is over. Measure instead:`);
  expect(server.requests).toEqual([]);
});

it("hides the sweep in a game alone, and the lanes unless they may be looked at", () => {
  expect([servedIn(VIEW.identify, question), servedIn(VIEW.identify, playing)]).toEqual([true, false]);
  const shows = { ...question, shows: ["kalman"] };
  expect([servedIn(VIEW.lanes, question), servedIn(VIEW.lanes, shows)]).toEqual([false, true]);
});

it.each(changing)("has no view %s on a bench that plays a recording", (view, kind) => {
  connect({ ...bench, replay_of: "rec", axes: kind.only === "axes" ? ["x", "y"] : [] } as typeof bench);
  mount(<PanelBody view={view as ViewName} params={{}} setParams={() => undefined} />);
  expect(screen.getByText("The past cannot be changed")).toBeVisible();
});
