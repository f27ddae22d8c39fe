import { act, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { dockNow, panelWith } from "../bench/dock";
import { connect } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { setLayout } from "./layouts";
import { Workspace } from "./workspace";

vi.mock("./panel-body", () => ({ PanelBody: ({ view }: { view: string }) => <p>This is the view {view}</p> }));

const flat = (await recordedBench("first-look")).bench;
const gyroscope = (await recordedBench("gyroscope")).bench;

beforeEach(() => {
  window.innerWidth = 1366;
});

/** The menu of the first group of the lecture layout, open. */
async function openMenu(bench = flat) {
  connect(bench);
  const { user } = mount(<Workspace />);
  act(() => setLayout("lecture"));
  await user.click(screen.getAllByRole("button", { name: "Add or close panels" })[0]);
  const search = await screen.findByRole("searchbox", { name: "Search panels, views and signals" });
  await waitFor(() => expect(search).toHaveFocus());
  return { user, search };
}
const items = () => screen.getAllByRole("menuitem").map((item) => item.textContent ?? "");
const isGone = () =>
  waitFor(() => expect(screen.queryByRole("searchbox", { name: /^Search panels/ })).not.toBeInTheDocument());

it("lists every panel of a bench in the order of work, each with a line of words", async () => {
  await openMenu();
  const wanted = [
    "Device",
    "Loop",
    "Controller",
    "Faults",
    "Scope",
    "Frequency response",
    "3D",
    "Diagnosis",
    "Why",
    "Compare",
    "Log",
    "Published",
    "Lesson",
  ];
  const found = items();
  expect(found).toHaveLength(wanted.length + 1);
  wanted.forEach((title, i) => {
    expect(found[i].startsWith(title), found[i]).toBe(true);
    expect(found[i].length, found[i]).toBeGreaterThan(title.length + 15);
  });
  expect(found.at(-1)).toBe("Close Displacement");
});

it("is a dialog with a search field and a menu of entries", async () => {
  const { search } = await openMenu();
  const frame = screen.getByRole("dialog");
  expect(frame).toContainElement(search);
  expect(frame).not.toHaveAttribute("aria-orientation");
  const menu = screen.getByRole("menu");
  expect(menu).not.toContainElement(search);
  expect(menu.querySelectorAll("[role=menuitem]")).toHaveLength(items().length);
});

it("has Motion and Rate for a gyroscope, and no frequency response", async () => {
  await openMenu(gyroscope);
  const found = items().join("\n");
  expect(found).toMatch(/^Motion/m);
  expect(found).toMatch(/^Rate/m);
  expect(found).not.toMatch(/^Frequency response/m);
});

it("finds a view by its name, and opens the first that is found by Enter", async () => {
  const { user, search } = await openMenu();
  await user.type(search, "hidden f");
  expect(items()).toEqual(["Hidden faultA view of Lesson", "LessonLab sheet, vote, hidden fault and games"]);
  await user.keyboard("{Enter}");
  expect(panelWith("blind")?.api.isActive).toBe(true);
  expect(screen.getByText("This is the view blind")).toBeInTheDocument();
  await isGone();
});

it("finds a scope by the name of a signal", async () => {
  const { user, search } = await openMenu();
  await user.type(search, "drive.voltage");
  expect(items()[0]).toMatch(/^VoltageA scope on .*drive\.voltage/);
  await user.click(screen.getAllByRole("menuitem")[0]);
  const opened = dockNow()?.panels.find(({ title }) => title === "Voltage");
  expect(opened?.params?.scope.signals).toEqual(expect.arrayContaining(["reference.voltage", "drive.voltage"]));
});

it("opens a view of a scope as a scope of its own", async () => {
  const { user, search } = await openMenu();
  await user.type(search, "phase{Enter}");
  expect(panelWith("phase")?.api.isActive).toBe(true);
  expect(dockNow()?.panels.filter(({ view }) => view.contentComponent === "scope")).toHaveLength(3);
});

it("says that nothing is found", async () => {
  const { user, search } = await openMenu();
  await user.type(search, "teapot");
  expect(screen.getByText("No panel, view or signal has this name.")).toBeVisible();
  await user.keyboard("{Enter}");
  expect(dockNow()?.panels).toHaveLength(5);
});

it("closes the panel in front", async () => {
  const { user } = await openMenu();
  await user.click(screen.getByRole("menuitem", { name: "Close Displacement" }));
  expect(dockNow()?.panels.map(({ title }) => title)).not.toContain("Displacement");
});

it("opens the entry that the arrows have marked", async () => {
  const { user, search } = await openMenu();
  await user.type(search, "view of controller{ArrowDown}{ArrowDown}{Enter}");
  expect(panelWith("sets")?.api.isActive).toBe(true);
  await isGone();
});
