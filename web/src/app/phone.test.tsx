import { act, screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { showPanel } from "../bench/dock";
import { pickSample } from "../bench/why";
import { showSheet } from "../panels/sheet/begin";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { drawOnce } from "../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { PANELS, panelsOn, VIEW, viewsOn } from "./panels";
import { Phone } from "./phone";

const { bench } = await recordedBench("first-look");
const { bench: gyroscope } = await recordedBench("gyroscope");
const { bench: hidden, asked } = await recordedAnswer("blind");
const catalog = await recordedAnswer("catalog");
const sheets = await recordedAnswer("sheets");
const explanation = await recordedAnswer("explanation");
const turn = await recordedAnswer("turn");

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/sheets", sheets);
  server.on("GET", "/classes", { classes: [] });
  server.on("GET", "/benches/:id/printed", { marks: [] });
  server.on("GET", "/benches/:id/blind", asked);
  server.on("GET", "/benches/:id/diagnosers/:name/explain", explanation);
  server.on("GET", "/benches/:id/diagnosers/:name/turn", turn);
});

const bar = () => within(screen.getByRole("group", { name: "Bench" }));
const scope = () => screen.getByRole("region", { name: /^Scope: / });
const lanes = () => screen.queryByRole("region", { name: "Diagnosis by kalman" });

it("has the scope above the lanes, and a bar for the thumb", () => {
  connect({ ...bench, state: "running" });
  mount(<Phone />);
  expect(scope()).toHaveAccessibleName(/plant\.displacement, sensor\.displacement, model\.displacement/);
  expect(lanes()).toBeVisible();
  expect(
    bar()
      .getAllByRole("button")
      .map((button) => button.textContent),
  ).toEqual(["Stop", "Controller", "Faults", "Lab sheet", "More"]);
  expect(screen.queryByRole("combobox", { name: /panel/i })).not.toBeInTheDocument();
});

it("draws no model beside a record, which followed none", () => {
  connect({ ...bench, record: { key: "a".repeat(64), samples: 100, labels: [] } });
  mount(<Phone />);
  expect(scope()).toHaveAccessibleName(/plant\.displacement, sensor\.displacement$/);
});

it("stops the bench and runs it", async () => {
  const board = connect({ ...bench, state: "running" });
  const { user } = mount(<Phone />);
  await user.click(bar().getByRole("button", { name: "Stop" }));
  board.status({ state: "paused" });
  await user.click(bar().getByRole("button", { name: "Run" }));
  expect(board.commands).toEqual([{ kind: "pause" }, { kind: "start" }]);
  board.status({ state: "tripped" });
  expect(bar().getByRole("button", { name: "Run" })).toBeDisabled();
});

it.each([
  ["Faults", "Faults"],
  ["Controller", "Choice"],
])("opens %s below the scope, and has the lanes back at a second press", async (word, region) => {
  connect(bench);
  const { user } = mount(<Phone />);
  await user.click(bar().getByRole("button", { name: word }));
  expect(bar().getByRole("button", { name: word })).toHaveAttribute("aria-pressed", "true");
  expect((await screen.findAllByRole("region", { name: region })).length).toBeGreaterThan(0);
  expect(scope()).toBeVisible();
  expect(lanes()).not.toBeInTheDocument();
  await user.click(bar().getByRole("button", { name: word }));
  expect(lanes()).toBeVisible();
});

it("goes to the other views of a panel, and closes it", async () => {
  connect(bench);
  const { user } = mount(<Phone />);
  act(() => showPanel("controllers"));
  const panel = within(screen.getByRole("region", { name: "Controller" }));
  await user.click(panel.getByRole("button", { name: "Adaptation" }));
  expect(panel.getByRole("button", { name: "Adaptation" })).toHaveAttribute("aria-pressed", "true");
  await user.click(screen.getByRole("button", { name: "Close Controller" }));
  expect(lanes()).toBeVisible();
});

it("lists every panel in a line of words, with each of its views but the scope that is in sight", async () => {
  connect(bench);
  const { user } = mount(<Phone />);
  await user.click(bar().getByRole("button", { name: "More" }));
  const list = within(await screen.findByRole("dialog", { name: "Panels" }));
  for (const panel of panelsOn(bench)) {
    expect(list.getByRole("heading", { name: PANELS[panel].title })).toBeVisible();
    expect(list.getByText(PANELS[panel].about)).toBeVisible();
    for (const view of viewsOn(panel, bench).filter((name) => name !== "time"))
      expect(list.getAllByRole("button", { name: VIEW[view].title }).length).toBeGreaterThan(0);
  }
  expect(list.queryByRole("button", { name: "Time" })).not.toBeInTheDocument();
  expect(list.getByRole("navigation", { name: "Pages" })).toBeVisible();
  await user.click(list.getByRole("button", { name: "Spectrum" }));
  expect(screen.getByRole("region", { name: "Spectrum" })).toBeVisible();
  expect(screen.queryByRole("dialog")).not.toBeInTheDocument();
});

it("shows a sheet that was begun below the scope", () => {
  connect(bench);
  mount(<Phone />);
  act(showSheet);
  expect(bar().getByRole("button", { name: "Lab sheet" })).toHaveAttribute("aria-pressed", "true");
  expect(scope()).toBeVisible();
});

it("explains a sample below the lanes it was chosen in", async () => {
  connect(bench);
  const { user } = mount(<Phone />);
  act(() => showPanel("events"));
  act(() => pickSample("kalman", 5));
  expect(lanes()).toBeVisible();
  expect(screen.getByRole("region", { name: "Why" })).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Close Why" }));
  expect(screen.queryByRole("region", { name: "Why" })).not.toBeInTheDocument();
});

it("asks for the answer where faults were while one is hidden", async () => {
  connect(hidden);
  const { user } = mount(<Phone />);
  expect(bar().queryByRole("button", { name: "Faults" })).not.toBeInTheDocument();
  expect(screen.getByRole("button", { name: "Sweep the device" })).toBeVisible();
  await user.click(bar().getByRole("button", { name: "Answer" }));
  expect(screen.getByRole("button", { name: "Commit the answer" })).toBeVisible();
  expect(scope()).toHaveAccessibleName("Scope: sensor.displacement, model.displacement");
});

it("gives a watcher the views and nothing that changes the bench", () => {
  be("watcher");
  connect(bench);
  mount(<Phone />);
  expect(
    bar()
      .getAllByRole("button")
      .map((button) => button.textContent),
  ).toEqual(["More"]);
  act(showSheet);
  expect(lanes()).toBeVisible();
});

it("shows the motion of a gyroscope below its rate", () => {
  connect(gyroscope);
  mount(<Phone />);
  expect(scope()).toHaveAccessibleName(/^Scope: rate\.rate/);
  expect(lanes()).not.toBeInTheDocument();
});

const divider = () => screen.getByRole("separator", { name: "Height of the scope" });
const height = () => Number(divider().getAttribute("aria-valuenow"));

it("moves the divider by arrows, and remembers it", async () => {
  connect(bench);
  const { user, unmount } = mount(<Phone />);
  expect(height()).toBe(45);
  divider().focus();
  await user.keyboard("{ArrowDown}{ArrowDown}{ArrowUp}");
  expect(height()).toBe(50);
  await user.keyboard("{End}{ArrowDown}");
  expect(height()).toBe(85);
  await user.keyboard("{Home}{ArrowUp}");
  expect(height()).toBe(15);
  expect(screen.getByRole("main")).toHaveStyle({ gridTemplateRows: "minmax(0, 15fr) auto minmax(0, 85fr)" });
  unmount();
  mount(<Phone />);
  expect(height()).toBe(15);
});

it("drags the divider", async () => {
  connect(bench);
  const { user } = mount(<Phone />);
  const at = (clientY: number) => ({ target: divider(), coords: { clientY } });
  await user.pointer(at(240));
  expect(height()).toBe(45);
  await user.pointer([{ ...at(180), keys: "[MouseLeft>]" }, at(240)]); // of 400 px
  await drawOnce();
  expect(height()).toBe(60);
});
