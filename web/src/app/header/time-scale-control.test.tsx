import { screen } from "@testing-library/react";
import { expect, it } from "vitest";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { StateBadge } from "./state-badge";
import { TimeScaleControl } from "./time-scale-control";

const { bench } = await recordedBench("first-look");
const running = { ...bench, state: "running" as const, time_scale: 0.002, achieved_scale: 0.001 };
const words = () => screen.getByRole("group", { name: "Time scale" }).textContent?.replace(/\s/g, " ");

it("shows the pace that is set and the one that is reached", () => {
  const board = connect({ ...running, capped: false });
  mount(<TimeScaleControl />);
  expect(words()).toContain("2.00 ms/sruns 1.00 ms/s");
  board.status({ capped: true });
  expect(words()).toContain("CAPPED runs 1.00 ms/s");
  board.status({ state: "paused", capped: false });
  expect(words()).toContain("stands still");
});

it.each([
  ["Real time", 1],
  ["As fast as possible", null],
])("sets the pace to %s", async (name, value) => {
  const board = connect(running);
  const { user } = mount(<TimeScaleControl />);
  await user.click(screen.getByTitle(/: change it$/));
  await user.click(await screen.findByRole("button", { name }));
  expect(board.commands).toEqual([{ kind: "time_scale", value }]);
});

it.each([
  ["quiet_lead", "quiet lead, fast"],
  ["skip", "skips, fast"],
] as const)("says that a bench hurries through its %s, until it no longer does", (fast_forward, text) => {
  const board = connect({ ...running, fast_forward });
  mount(<TimeScaleControl />);
  expect(words()).toContain(text);
  board.status({ fast_forward: null });
  expect(words()).not.toContain("fast");
});

it("says the state of the bench, and that it is not known once the connection is closed", async () => {
  const board = connect(running);
  mount(<StateBadge />);
  const badge = screen.getByTestId("bench-state");
  expect(badge).toHaveTextContent("running");
  board.status({ state: "tripped" });
  expect(badge).toHaveTextContent("tripped");
  await board.drop(4403);
  expect(badge).toHaveTextContent("not connected");
  expect(badge).toHaveAttribute("data-state", "unknown");
});
