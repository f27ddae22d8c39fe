import { act, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { startTour, tourSeen, useTour } from "./run-tour";
import { TourList } from "./tour-list";
import { TOURS } from "./tours";

const { bench } = await recordedBench("first-look");
const mine = { ...bench, id: "mine", state: "running" as const, watchers: 1 };
const ofTour = { ...bench, id: "of-tour", state: "running" as const };

/** The page as it is while the first two bubbles of a tour look at it. */
const tour = {
  ...TOURS[0],
  steps: [
    { title: "First", text: "One", at: () => document.body },
    { title: "A run of its own", text: "Two", at: () => document.body, does: runOfTour().does },
  ],
};

function runOfTour() {
  const found = TOURS.flatMap(({ steps }) => steps).find(({ title }) => title === "A run of its own");
  if (!found) throw new Error("no tour starts a run");
  return found;
}

beforeEach(() => {
  server.on("POST", "/benches/:id/commands", { ok: true });
  server.on("POST", "/benches", ofTour);
  server.on("DELETE", "/benches/:id");
  server.on("GET", "/benches/:id", mine);
  server.on("GET", "/runs", { runs: [] });
  server.on("POST", "/runs", { id: "run-of-tour" });
  server.on("DELETE", "/runs/:id", { state: "cancelled" });
  server.on("POST", "/runs/remove", { removed: 1 });
});

/** The requests that change something, in their order. */
const done = () =>
  server.requests.filter(({ method }) => method !== "GET").map(({ method, path, body }) => [method, path, body]);

async function begin() {
  const board = connect(mine);
  useView.setState({ page: "gallery", layout: "lab" });
  let ended = false;
  void startTour(tour).then(() => {
    ended = true;
  });
  await waitFor(() => expect(window.location.search).toContain("bench=of-tour"));
  board.hello(ofTour);
  await screen.findByText("First");
  return { board, ended: () => ended };
}

const press = (name: string) => act(async () => screen.getByRole("button", { name }).click());

it("pauses the bench, drives one of its own, and at its end puts all back and removes its run", async () => {
  const { ended } = await begin();
  expect(done()).toEqual([
    ["POST", "/benches/mine/commands", { kind: "pause" }],
    ["POST", "/benches", { scenario: "first-look", paused: false }],
  ]);
  expect(useView.getState().page).toBe("bench");
  await press("Next");
  await screen.findByText("2 of 2");
  await press("Done");
  await waitFor(() => expect(ended()).toBe(true));
  expect(done().slice(2)).toEqual([
    ["POST", "/runs", expect.objectContaining({ scenario: expect.any(String) })],
    ["POST", "/benches/mine/commands", { kind: "start" }],
    ["DELETE", "/benches/of-tour", undefined],
    ["DELETE", "/runs/run-of-tour", undefined],
    ["POST", "/runs/remove", { ids: ["run-of-tour"] }],
  ]);
  expect(window.location.search).toContain("bench=mine");
  expect(useView.getState()).toMatchObject({ page: "gallery", layout: "lab" });
  expect(useTour.getState().runs).toBe(false);
});

it("puts all back when it is left by Escape", async () => {
  const { ended } = await begin();
  act(() => void window.dispatchEvent(new KeyboardEvent("keyup", { key: "Escape" })));
  await waitFor(() => expect(ended()).toBe(true));
  expect(done().slice(2)).toEqual([
    ["POST", "/benches/mine/commands", { kind: "start" }],
    ["DELETE", "/benches/of-tour", undefined],
  ]);
  expect(screen.queryByText("First")).not.toBeInTheDocument();
});

it("leaves a bench paused that was paused, or that others watch", async () => {
  for (const found of [
    { ...mine, state: "paused" as const },
    { ...mine, watchers: 2 },
  ]) {
    server.requests = [];
    const board = connect(found);
    const ended = startTour(tour);
    await waitFor(() => expect(window.location.search).toContain("bench=of-tour"));
    board.hello(ofTour);
    await screen.findByText("First");
    act(() => void window.dispatchEvent(new KeyboardEvent("keyup", { key: "Escape" })));
    await ended;
    expect(done().map(([method, path]) => `${method} ${path}`)).toEqual(["POST /benches", "DELETE /benches/of-tour"]);
  }
});

it("says why no bench was made, and leaves all as it was", async () => {
  server.on("POST", "/benches", new Refusal(409, "There is no free bench."));
  mount(<TourList />);
  connect(mine);
  await act(() => startTour(tour));
  expect(await screen.findByText("There is no free bench.")).toBeVisible();
  expect(done().map(([, path, body]) => [path, body])).toEqual([
    ["/benches/mine/commands", { kind: "pause" }],
    ["/benches", { scenario: "first-look", paused: false }],
    ["/benches/mine/commands", { kind: "start" }],
  ]);
  expect(useBench.getState().bench?.id ?? "mine").toBe("mine");
});

it("lists every tour for a teacher, and none for a student", () => {
  const { unmount } = mount(<TourList />);
  expect(screen.getAllByRole("button").map((button) => button.textContent)).toEqual([
    "First look round",
    "Faults",
    "Controllers",
    "Diagnosis",
    "Runs and claims",
  ]);
  unmount();
  be("student");
  mount(<TourList />);
  expect(screen.queryByRole("button")).not.toBeInTheDocument();
});

it("is offered once", async () => {
  expect(tourSeen()).toBe(false);
  const { ended } = await begin();
  expect(tourSeen()).toBe(true);
  act(() => void window.dispatchEvent(new KeyboardEvent("keyup", { key: "Escape" })));
  await waitFor(() => expect(ended()).toBe(true));
});
