import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { useView } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { ClassPage } from "./class-page";

const { class: group, members } = await recordedAnswer("class");
const catalog = await recordedAnswer("catalog");
const { scenarios } = await recordedAnswer("scenarios");
const { bench } = await recordedBench("first-look");
const [ada, ben] = members;
const LIBRARY = ["first-look", "ch1-step", "ch1-table-1-1", "ch5-seven-step"];
const SHEETS = {
  sheets: [{ id: "first", title: "First sheet", summary: "", minutes: 5, points: 3, steps: 2, own: false, work: null }],
  current: null,
};
const outcome = (done: number, failed: string[] = []) => ({ done, failed });

beforeEach(() => {
  vi.spyOn(window, "confirm").mockReturnValue(true);
  server.on("GET", "/classes", { classes: [group] });
  server.on("GET", "/classes/:id/members", { members });
  server.on("GET", "/catalog", { blocks: catalog.blocks.filter(({ family }) => family === "faults") });
  server.on("GET", "/scenarios", { scenarios: scenarios.filter(({ id }) => LIBRARY.includes(id)) });
  server.on("GET", "/sheets", SHEETS);
  for (const path of ["commands", "scenario", "start", "blind", "sheet"])
    server.on("POST", `/classes/class-1/${path}`, outcome(2));
  server.on("DELETE", "/classes/class-1/blind", outcome(2));
});

async function mountClass(chosen: string[] = []) {
  const shown = mount(<ClassPage />);
  const all = within(await screen.findByRole("region", { name: "For all benches" }));
  await all.findByRole("option", { name: "Added mass" });
  await all.findByRole("option", { name: "First sheet" });
  for (const name of chosen) await shown.user.click(screen.getByRole("checkbox", { name: `Choose ${name}` }));
  const sent = (path: string) => server.asked("POST", `/classes/class-1/${path}`).map(({ body }) => body);
  return { ...shown, all, sent };
}

it.each([
  ["Freeze", { kind: "pause" }],
  ["Release", { kind: "start" }],
  ["Heal all", { heal: "all" }],
  ["Inject", { fault: "added_mass", severity: 0.05 }],
])("%s is for all, or for the students chosen", async (name, command) => {
  const { user, all, sent } = await mountClass();
  if (name === "Inject") await user.selectOptions(all.getByLabelText("Fault"), "Added mass");
  await user.click(all.getByRole("button", { name }));
  await all.findByText(/: 2 done\.$/);
  await user.click(screen.getByRole("checkbox", { name: "Choose Ben" }));
  expect(all.getByText("For the 1 chosen")).toBeVisible();
  await user.click(all.getByRole("button", { name }));
  await waitFor(() => expect(sent("commands")).toHaveLength(2));
  expect(sent("commands")).toEqual([
    { command, members: null },
    { command, members: [ben.id] },
  ]);
});

it("injects a severity that is typed in percent, and none beyond its limits", async () => {
  const { user, all, sent } = await mountClass();
  await user.selectOptions(all.getByLabelText("Fault"), "Added mass");
  const severity = all.getByLabelText("Severity of Added mass");
  await user.clear(severity);
  await user.type(severity, "7.5");
  await user.click(all.getByRole("button", { name: "Inject" }));
  expect(sent("commands")).toEqual([{ command: { fault: "added_mass", severity: 0.075 }, members: null }]);
  await user.clear(severity);
  expect(all.getByRole("button", { name: "Inject" })).toBeDisabled();
});

it("starts all together, or those chosen, when it is confirmed", async () => {
  const { user, all, sent } = await mountClass(["Ada"]);
  vi.mocked(window.confirm).mockReturnValueOnce(false);
  await user.click(all.getByRole("button", { name: "Start all together" }));
  expect(sent("start")).toEqual([]);
  await user.click(all.getByRole("button", { name: "Start all together" }));
  await user.click(all.getByRole("button", { name: "Choose none" }));
  await user.click(all.getByRole("button", { name: "Start all together" }));
  expect(sent("start")).toEqual([{ members: [ada.id] }, { members: null }]);
});

it("begins a scenario on all, and on none while some are chosen", async () => {
  const { user, all, sent } = await mountClass();
  await user.selectOptions(all.getByLabelText("Scenario"), "ch5-seven-step");
  await user.click(all.getByRole("button", { name: "Begin on all" }));
  expect(sent("scenario")).toEqual([{ scenario: "ch5-seven-step", paused: false, quiet_lead: true }]);
  await user.click(screen.getByRole("checkbox", { name: "Choose Ada" }));
  expect(all.getByRole("button", { name: "Begin on all" })).toBeDisabled();
});

it("hides a fault from all or from those chosen, with the bank or without, and reveals all", async () => {
  const { user, all, sent } = await mountClass();
  await user.click(all.getByRole("button", { name: "Set hidden faults" }));
  await user.click(screen.getByRole("checkbox", { name: "Choose Ben" }));
  await user.click(all.getByRole("checkbox", { name: "Show the bank" }));
  await user.click(all.getByRole("button", { name: "Set hidden faults" }));
  await user.click(all.getByRole("button", { name: "Reveal answers" }));
  expect(sent("blind")).toEqual([
    { scenario: "ch5-seven-step", shows: false, members: null },
    { scenario: "ch5-seven-step", shows: true, members: [ben.id] },
  ]);
  expect(server.asked("DELETE", "/classes/class-1/blind")).toHaveLength(1);
});

it("begins a sheet on all or on those chosen, and offers the points", async () => {
  const { user, all, sent } = await mountClass();
  await user.click(all.getByRole("button", { name: "Begin sheet on all" }));
  await user.click(screen.getByRole("checkbox", { name: "Choose Ben" }));
  await user.click(all.getByRole("button", { name: "Begin sheet" }));
  expect(sent("sheet")).toEqual([
    { sheet: "first", members: null },
    { sheet: "first", members: [ben.id] },
  ]);
  expect(all.getByRole("link", { name: "Points, CSV" })).toHaveAttribute(
    "href",
    "./api/v1/classes/class-1/grades?format=csv",
  );
});

it("resets the trips of those that tripped, chosen or all", async () => {
  const tripped = members.map((tile) => ({ ...tile, state: "tripped" }));
  server.on("GET", "/classes/:id/members", { members: tripped });
  const { user, all, sent } = await mountClass();
  expect(screen.getByText(/2 tripped/)).toBeVisible();
  await user.click(all.getByRole("button", { name: /^Reset 2\strips$/ }));
  await user.click(screen.getByRole("checkbox", { name: "Choose Ben" }));
  await user.click(all.getByRole("button", { name: /^Reset 1\strip$/ }));
  expect(sent("commands")).toEqual([
    { command: { reset_trip: true }, members: [ada.id, ben.id] },
    { command: { reset_trip: true }, members: [ben.id] },
  ]);
});

it("says what became of it, who refused included, and what the server says", async () => {
  server.on("POST", "/classes/class-1/commands", outcome(1, ["Ben: the bench has tripped"]));
  const { user, all } = await mountClass();
  await user.click(all.getByRole("button", { name: "Freeze" }));
  expect(await all.findByText("Freeze: 1 done, 1 refused: Ben: the bench has tripped.")).toBeVisible();
  server.on("POST", "/classes/class-1/commands", new Refusal(404, "There is no such class."));
  await user.click(all.getByRole("button", { name: "Release" }));
  expect(await screen.findByText("There is no such class.")).toBeVisible();
});

it("does nothing for all while nobody is there, and says so", async () => {
  server.on("GET", "/classes/:id/members", { members: [] });
  const { all } = await mountClass();
  expect(screen.getByText("No student has joined yet")).toBeVisible();
  for (const name of [
    "Freeze",
    "Release",
    "Start all together",
    "Inject",
    "Heal all",
    "Begin on all",
    "Set hidden faults",
  ])
    expect(all.getByRole("button", { name })).toBeDisabled();
});

it("shows the bench of the page to all, and ends that", async () => {
  connect(bench);
  server.on("PUT", "/classes/class-1/shown", group);
  server.on("DELETE", "/classes/class-1/shown", group);
  const { user } = await mountClass();
  server.on("GET", "/classes", { classes: [{ ...group, shown: bench.id }] });
  await user.click(screen.getByRole("button", { name: "Show my bench to all" }));
  expect(server.asked("PUT", "/classes/class-1/shown")[0].body).toEqual({ bench: bench.id });
  expect(await screen.findByText(/^All see one bench/)).toBeVisible();
  await user.click(screen.getByRole("button", { name: "End showing" }));
  expect(server.asked("DELETE", "/classes/class-1/shown")).toHaveLength(1);
});

it("shows who did what, newest first", async () => {
  const entry = { at: "2026-01-01T00:00:00Z", class_id: "class-1", kind: "command", tick: 7 };
  server.on("GET", "/classes/class-1/audit", {
    entries: [
      { ...entry, actor: "Ada", bench_id: ada.bench, text: "injected <b>mass</b>" },
      { ...entry, actor: "The teacher", bench_id: ben.bench, text: "paused", tick: null },
    ],
  });
  const { user } = await mountClass();
  await user.click(screen.getByRole("button", { name: "Activity" }));
  const rows = within(await screen.findByRole("list", { name: "Activity, newest first" })).getAllByRole("listitem");
  expect(rows.map((row) => row.querySelector("p")?.textContent?.replace(/\s/g, " "))).toEqual([
    "Ada: injected <b>mass</b> tick 7",
    "The teacher on the bench of Ben: paused",
  ]);
});

it("ends a class when that is confirmed, and offers to open one", async () => {
  server.on("DELETE", "/classes/class-1");
  const { user } = await mountClass();
  vi.mocked(window.confirm).mockReturnValueOnce(false);
  await user.click(screen.getByRole("button", { name: "End the class…" }));
  expect(server.asked("DELETE", "/classes/class-1")).toEqual([]);
  server.on("GET", "/classes", { classes: [] });
  await user.click(screen.getByRole("button", { name: "End the class…" }));
  expect(await screen.findByRole("button", { name: "Open the class" })).toBeVisible();
  expect(server.asked("DELETE", "/classes/class-1")).toHaveLength(1);
});

it("opens a bench of a student from the tile", async () => {
  const { user } = await mountClass();
  useView.setState({ page: "class" });
  await user.click(screen.getByRole("button", { name: "Ada" }));
  expect(window.location.search).toBe(`?bench=${ada.bench}`);
  expect(useView.getState().page).toBe("bench");
});
