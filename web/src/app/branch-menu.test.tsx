import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useCatalog } from "../api/use-catalog";
import { Refusal, server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { BranchMenu } from "./branch-menu";
import { TimeBar } from "./time-bar";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const fork = { ...bench, id: "fork" };

/** The menu, once the catalogue has come with the titles. */
const Titled = () => useCatalog().blocks.length > 0 && <BranchMenu bench={bench} />;

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("POST", "/benches/:id/fork", fork);
  server.on("PATCH", "/benches/fork", fork);
  server.on("GET", "/benches", { benches: [] });
});

it("forks now and heals, for a future without a fault, and names it", async () => {
  const board = connect(bench);
  const { user } = mount(<Titled />);
  await user.click(await screen.findByRole("button", { name: "Branch here" }));
  await user.click(await screen.findByRole("menuitem", { name: "Without added mass" }));
  expect(server.asked("POST", `/benches/${bench.id}/fork`)[0].body).toEqual({
    tick: bench.tick,
    paused: true,
    window_ticks: 20_000,
  });
  await waitFor(() => expect(window.location.search).toContain("bench=fork"));
  board.hello(fork);
  await waitFor(() => expect(board.commands).toEqual([{ heal: ["added_mass"] }]));
  await board.reply();
  await waitFor(() => expect(board.commands.at(-1)).toEqual({ kind: "start" }));
  await board.reply();
  expect(server.asked("PATCH", "/benches/fork")[0].body).toEqual({ name: "without Added mass" });
});

it("offers the other controllers and the diagnosers that the bench has not", async () => {
  connect(bench);
  const { user } = mount(<Titled />);
  await user.click(await screen.findByRole("button", { name: "Branch here" }));
  await screen.findByText("With another diagnoser from tick 0");
  const items = screen.getAllByRole("menuitem").map((item) => item.textContent);
  expect(items.slice(0, 2)).toEqual(["Go on as it was", "Without added mass"]);
  expect(items).not.toContain("With Open loop");
  expect(items).not.toContain("With Kalman bank (MMAE)");
  for (const name of bench.controllers.filter((one) => one !== bench.controller)) {
    const card = catalog.blocks.find((block) => block.family === "control" && block.name === name);
    expect(items).toContain(`With ${card?.title}`);
  }
});

it("says why there is no branch", async () => {
  server.on("POST", "/benches/:id/fork", new Refusal(409, "There is no free bench."));
  connect(bench);
  const { user } = mount(<Titled />);
  await user.click(await screen.findByRole("button", { name: "Branch here" }));
  await user.click(await screen.findByRole("menuitem", { name: "Go on as it was" }));
  expect(await screen.findByText("There is no free bench.")).toBeVisible();
});

it("has a timeline for a teacher alone, and none on a bench that plays a recording", () => {
  const board = connect({ ...bench, earliest_tick: 0 });
  const { unmount } = mount(<TimeBar />);
  expect(screen.getByRole("slider", { name: "Moment shown by all panels" })).toBeVisible();
  board.hello({ ...bench, earliest_tick: 0, replay_of: "rec" });
  expect(screen.queryByRole("slider")).not.toBeInTheDocument();
  unmount();
  be("student");
  connect({ ...bench, earliest_tick: 0 });
  mount(<TimeBar />);
  expect(screen.queryByRole("slider")).not.toBeInTheDocument();
});
