import { screen } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { useKeys } from "../use-keys";
import { ControllerSelect } from "./controller-select";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");

beforeEach(() => server.on("GET", "/catalog", catalog));

function Header() {
  useKeys();
  return <ControllerSelect />;
}

/** The list on a page with keys. */
function mountList(of = bench) {
  const board = connect(of);
  const { user } = mount(<Header />);
  return { board, user, list: screen.getAllByRole("combobox")[0] };
}

it("gives the page its keys back after Escape", async () => {
  const { board, user, list } = mountList();
  await user.click(list);
  await screen.findByText("PID");
  expect(list).toHaveAttribute("aria-expanded", "true");
  await user.keyboard("{Escape}");
  expect(list).toHaveAttribute("aria-expanded", "false");
  await user.keyboard(" ");
  expect(board.commands).toEqual([{ kind: "start" }]);
});

it("sends the controller that is chosen once, shows that of the board, and gives the keys back", async () => {
  const { board, user, list } = mountList();
  await user.click(list);
  await user.click(await screen.findByText("PID"));
  expect(board.commands).toEqual([{ switch: "pid", cold: false }]);
  board.status({ controller: "pid", slots: { "": "pid" } });
  await board.reply();
  expect(list).toHaveValue("PID");
  await user.keyboard(" ");
  expect(board.commands[1]).toEqual({ kind: "start" });
});

it("shows the controller of the last slot of a gyroscope, by its slot", async () => {
  const { list } = mountList(gyroscope.bench);
  await screen.findByDisplayValue(catalog.blocks.find((b) => b.name === "adaptive_rate")?.title as string);
  expect(list).toHaveAccessibleName("Sense controller");
});

it("is not for a watcher", () => {
  be("watcher");
  expect(mountList().list).toBeDisabled();
});

it("is not for a replay", () => {
  expect(mountList({ ...bench, replay_of: "recording-1" }).list).toBeDisabled();
});
