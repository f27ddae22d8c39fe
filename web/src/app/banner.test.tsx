import { act, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { Banner } from "./banner";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");

beforeEach(() => {
  vi.useFakeTimers();
  vi.spyOn(Math, "random").mockReturnValue(0.5);
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/benches/:id", bench);
});
afterEach(() => vi.useRealTimers());

const pass = (ms: number) => act(() => vi.advanceTimersByTimeAsync(ms));
const notice = () => screen.queryByRole("region", { name: "Notice" });

it("says nothing while the connection holds", async () => {
  connect(bench);
  mount(<Banner />);
  await pass(900);
  expect(notice()).not.toBeInTheDocument();
});

it("counts down to the next attempt once a lost connection is more than a blink, and is gone after it", async () => {
  const board = connect(bench);
  mount(<Banner />);
  await board.drop();
  expect(notice()).not.toBeInTheDocument();
  await pass(500); // the first attempt
  await board.drop();
  await pass(800);
  expect(notice()).toHaveTextContent("Connection lost");
  expect(notice()).toHaveTextContent(/Stale since \d/);
  expect(notice()).toHaveTextContent("again in 1 s");
  await pass(500);
  board.hello(bench);
  await pass(0);
  expect(notice()).not.toBeInTheDocument();
});

it("tries at once when asked to", async () => {
  const board = connect(bench);
  const { user } = mount(<Banner />);
  await board.drop();
  await pass(500);
  for (const wait of [1000, 2000]) {
    await board.drop();
    await pass(wait);
  }
  await board.drop();
  await user.click(screen.getByRole("button", { name: "Try now" }));
  board.hello(bench);
  await pass(0);
  expect(notice()).not.toBeInTheDocument();
});

it("says since when nothing was heard", async () => {
  const board = connect(bench);
  mount(<Banner />);
  await pass(3000);
  expect(notice()).toHaveTextContent(/^Nothing heard, stale since \d/);
  board.status({});
  await pass(250);
  expect(notice()).not.toBeInTheDocument();
});

it.each([
  [4404, "This bench was closed", ["Start it again", "Open my own"]],
  [4403, "This bench is not yours", ["Start it again", "Open my own"]],
  [4401, "You are not logged in", ["Reload"]],
  [4001, "The server speaks a newer version", ["Reload"]],
  [4003, "This address may not open the bench", []],
])("says why a connection was closed for good with %i, and what can be done", async (code, title, offers) => {
  const board = connect(bench);
  mount(<Banner />);
  await board.drop(code);
  expect(notice()).toHaveTextContent(title);
  expect(screen.queryAllByRole("button").map((button) => button.textContent)).toEqual(offers);
});

it("offers a watcher no bench of their own", async () => {
  be("watcher");
  const board = connect(bench);
  mount(<Banner />);
  await board.drop(4404);
  expect(notice()).toHaveTextContent("This bench was closed");
  expect(screen.queryByRole("button")).not.toBeInTheDocument();
});

it("says that the board has tripped, and resets the trip", async () => {
  const board = connect(bench);
  const { user } = mount(<Banner />);
  board.status({ state: "tripped", trip: { reason: "tripped: displacement beyond 8 µm", tick: 2000 } as never });
  expect(notice()).toHaveTextContent("Tripped: displacement beyond 8 µm");
  await user.click(screen.getByRole("button", { name: "Reset the trip" }));
  expect(board.commands).toEqual([{ reset_trip: true }]);
});

it("says that the server has to be restarted as long as its engine hangs for good", async () => {
  const board = connect(bench);
  mount(<Banner />);
  board.status({ is_stuck: true });
  await pass(0);
  expect(notice()).toHaveTextContent("The server has to be restarted");
  board.status({ is_stuck: false });
  await pass(0);
  expect(notice()).not.toBeInTheDocument();
});
