import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useAnnouncements } from "../../bench/announce";
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

it("copies the command behind an event for a shell, a headless run and Python", async () => {
  const board = connect(bench);
  const { user } = mount(<EventsPanel />);
  await board.events(events);
  const list = within(screen.getByRole("list", { name: "Events, newest first" }));
  const copy = list.getByRole("button", { name: /^Copy: inject added_mass/ });
  expect(list.getAllByRole("button", { name: /^Copy: / })).toHaveLength(events.filter((e) => e.command).length);
  for (const [item, text] of [
    ["REST, with curl", `http://localhost:3000/api/v1/benches/${bench.id}/commands`],
    ["Command line, headless", 'combbench run first-look --set \'events=[{at_sample = 1800, fault = "added_mass",'],
    ["Python", `Bench(lab, "${bench.id}").command(fault="added_mass", severity=0.05)`],
  ]) {
    await user.click(copy);
    await user.click(await screen.findByRole("menuitem", { name: item }));
    expect(await navigator.clipboard.readText()).toContain(text);
  }
  expect(useAnnouncements.getState().polite).toBe("Command copied.");
});

it("offers no headless run for a command that runs the bench", async () => {
  const board = connect(bench);
  const { user } = mount(<EventsPanel />);
  await board.events(events);
  await user.click(screen.getByRole("button", { name: "Copy: stepped 200 ticks" }));
  const items = await screen.findAllByRole("menuitem");
  expect(items.map((item) => item.textContent)).toEqual(["REST, with curl", "Python"]);
});

it("shows older events on request", async () => {
  const board = connect(bench);
  const { user } = mount(<EventsPanel />);
  await board.events(Array.from({ length: 301 }, (_, n) => ({ ...injected, seq: events.length + n + 1 })));
  expect(rows()).toHaveLength(301); // 300 events and the button
  await user.click(screen.getByRole("button", { name: "Show older" }));
  expect(rows()).toHaveLength(301);
  expect(screen.queryByRole("button", { name: "Show older" })).not.toBeInTheDocument();
});
