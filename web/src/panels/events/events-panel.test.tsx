import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { jump } from "../../ui/hover";
import { EventsPanel } from "./events-panel";

const { bench, events } = await recordedBench("first-look");
const injected = events.find(({ kind }) => kind === "inject") as (typeof events)[number];

beforeEach(() => server.on("GET", "/classes", { classes: [] }));

const rows = () => within(screen.getByRole("list", { name: "Events, newest first" })).getAllByRole("listitem");

it("says that nothing has happened yet", () => {
  connect(bench);
  mount(<EventsPanel />);
  expect(screen.getByText("Nothing has happened yet")).toBeVisible();
});

it("lists events with their numbers and device times, the newest first", async () => {
  const board = connect(bench);
  mount(<EventsPanel />);
  await board.events(events);
  expect(rows()).toHaveLength(events.length);
  expect(rows().map((row) => Number(row.querySelector("span")?.textContent))).toEqual(
    events.map(({ seq }) => seq).reverse(),
  );
  expect(screen.getByText(injected.text).closest("li")).toHaveTextContent("18.000 ms");
});

it("takes the scopes to an event that is clicked", async () => {
  const board = connect(bench);
  const { user } = mount(<EventsPanel />);
  await board.events(events);
  const went: unknown[] = [];
  const stop = jump.listen((to) => went.push(to));
  await user.click(screen.getByText(injected.text));
  stop();
  expect(went).toEqual([{ tick: injected.tick }]);
});

it("offers a teacher, and no student, a branch without a change", async () => {
  const board = connect(bench);
  const { unmount } = mount(<EventsPanel />);
  await board.events(events);
  const name = `Branch without this: ${injected.text}`;
  expect(screen.getByRole("button", { name })).toBeVisible();
  unmount();
  be("student");
  mount(<EventsPanel />);
  expect(screen.getByText(injected.text)).toBeVisible();
  expect(screen.queryByRole("button", { name })).not.toBeInTheDocument();
});
