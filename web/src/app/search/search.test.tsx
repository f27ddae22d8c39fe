import { act, fireEvent, screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useView } from "../../bench/view-store";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { useKeys } from "../use-keys";
import { Search } from "./search";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const devices = await recordedAnswer("devices");
const [control] = catalog.blocks.filter(
  ({ family, name, parameters }) => family === "control" && bench.controllers.includes(name) && parameters.length > 0,
);
const [, device] = devices.devices;

beforeEach(() => {
  server.on("GET", "/catalog", { blocks: [control] });
  server.on("GET", "/devices", devices);
  server.on("GET", "/scenarios", { scenarios: [{ id: "ch5-seven-step", title: "Seven steps" }] });
});

function Page() {
  useKeys();
  return <Search />;
}

async function open(asked = "") {
  connect(bench);
  const { user } = mount(<Page />);
  await user.keyboard("{Control>}k{/Control}");
  const field = within(await screen.findByRole("dialog", { name: "Search" })).getByRole("textbox", { name: "Search" });
  if (asked) await user.type(field, asked);
  return { user, option: (name: RegExp) => screen.findByRole("button", { name }) };
}

it("Ctrl K opens it with the places and panels there are for the person", async () => {
  be("student");
  const { option } = await open();
  expect(await option(/^Gallery/)).toBeVisible();
  expect(screen.queryByRole("button", { name: /^Class/ })).not.toBeInTheDocument();
  expect(await option(/^Diagnosis/)).toBeVisible();
  expect(screen.queryByRole("button", { name: /^Motion/ })).not.toBeInTheDocument();
});

it.each([
  ["a place", "scores", /^Scores/, "/scores"],
  ["a scenario", "seven step", /^Seven steps/, "/gallery/ch5-seven-step"],
  ["a device", device.id, new RegExp(`^${device.title.slice(0, 12)}`), `/design/${device.id}`],
])("opens %s", async (_, asked, name, path) => {
  const { user, option } = await open(asked);
  await user.click(await option(name));
  expect(window.location.pathname).toBe(path);
});

it("opens the index at an equation", async () => {
  const title = `${control.title} ${control.equations[0].label.replaceAll("_", " ")}`;
  const { user, option } = await open(title);
  await user.click(await option(new RegExp(`^${title}`)));
  expect(useView.getState()).toMatchObject({ page: "theory", item: title });
});

it("opens the block of a setting", async () => {
  const { user } = await open(`controllers.${control.name}.${control.parameters[0].name}`);
  const settings = within(await screen.findByRole("group", { name: "Settings" }));
  await user.click(settings.getAllByRole("button")[0]);
  expect(useView.getState()).toMatchObject({ card: `controllers.${control.name}`, extra: "card" });
});

it("opens a view of a panel, from another page as well", async () => {
  const { user, option } = await open("spectrum");
  act(() => useView.setState({ page: "gallery" }));
  await user.click(await option(/^Spectrum/));
  expect(useView.getState()).toMatchObject({ page: "bench", extra: "spectrum" });
});

it("says when nothing has all words", async () => {
  await open("no such thing at all");
  expect(await screen.findByText("Nothing has all these words.")).toBeVisible();
});

it("opens the first entry with Enter, also after letters that came before the field", async () => {
  const { option } = await open();
  for (const key of "scores") fireEvent.keyDown(document.body, { key });
  await option(/^Scores/);
  fireEvent.keyDown(screen.getByRole("textbox", { name: "Search" }), { key: "Enter", code: "Enter" });
  expect(window.location.pathname).toBe("/scores");
});

it("takes letters that are typed before it has the keyboard, which are no keys of the page then", async () => {
  await open();
  fireEvent.keyDown(document.body, { key: "n" });
  expect(screen.getByRole("textbox", { name: "Search" })).toHaveValue("n");
  expect(useView.getState().dialog).toBe("none");
});
