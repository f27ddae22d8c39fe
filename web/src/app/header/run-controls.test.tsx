import { screen } from "@testing-library/react";
import { expect, it } from "vitest";
import type { Bench } from "../../api/types";
import { connect } from "../../testing/fake-transport";
import { be, mount } from "../../testing/render";
import { RunControls } from "./run-controls";

const bench = {
  id: "b1",
  title: "A bench",
  state: "paused",
  drive_period_ticks: 12,
  parameters: {},
} as unknown as Bench;

const button = (name: string) => screen.getByRole("button", { name });

it("runs on Run", async () => {
  const board = connect(bench);
  const { user } = mount(<RunControls />);
  await user.click(button("Run"));
  expect(board.commands).toEqual([{ kind: "start" }]);
});

it.each([
  [/^One tick/, { kind: "step", ticks: 1 }],
  [/^One drive period/, { kind: "step_period" }],
  [/^Reset to the start/, { kind: "reset" }],
])("sends the command of %s in the menu of steps", async (name, command) => {
  const board = connect(bench);
  const { user } = mount(<RunControls />);
  await user.click(button("Step"));
  await user.click(await screen.findByRole("menuitem", { name }));
  expect(board.commands).toEqual([command]);
});

it("says that a drive has no period, and offers no step of one", async () => {
  connect({ ...bench, drive_period_ticks: null });
  const { user } = mount(<RunControls />);
  await user.click(button("Step"));
  const item = await screen.findByRole("menuitem", { name: /^One drive period/ });
  expect(item).toBeDisabled();
  expect(item).toHaveTextContent("The drive has no period of its own");
});

it("pauses a bench that runs, and runs one that has paused", async () => {
  const board = connect({ ...bench, state: "running" });
  const { user } = mount(<RunControls />);
  await user.click(button("Pause"));
  expect(board.commands).toEqual([{ kind: "pause" }]);
  board.status({ state: "paused" });
  await board.reply(7);
  await user.click(button("Run"));
  expect(board.commands.at(-1)).toEqual({ kind: "start" });
});

it("shows the words of a refusal", async () => {
  const board = connect(bench);
  const { user } = mount(<RunControls />);
  await user.click(button("Run"));
  await board.refuse("The bench is at its end.", { field: "kind", hint: "Reset it." });
  expect(screen.getByRole("alert")).toHaveTextContent("The bench is at its end.Field: kind. Reset it.");
});

it("sends nothing for a watcher", async () => {
  be("watcher");
  const board = connect(bench);
  const { user } = mount(<RunControls />);
  await user.click(button("Run"));
  expect(board.commands).toEqual([]);
});
