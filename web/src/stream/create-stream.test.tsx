import { act } from "@testing-library/react";
import { expect, it, vi } from "vitest";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { useBench } from "./bench-store";
import { stream } from "./stream";

const { bench, status, events } = await recordedBench("first-look");
const now = () => useBench.getState();

it("shows what a status changes and keeps what it leaves out", () => {
  const board = connect(bench);
  board.status({ state: "running", tick: 2100, parameters: null, dropped_frames: 3 });
  expect(now().bench).toMatchObject({
    state: "running",
    tick: 2100,
    parameters: bench.parameters,
    faults: bench.faults,
  });
  expect(now().droppedFrames).toBe(3);
  board.status({ scores: status.scores });
  board.status({ faults: [] });
  expect(now().scores).toEqual(status.scores);
  expect(now().bench?.faults).toEqual([]);
});

it("draws the pictures again when an event or a change of the acting faults comes, on a board that stands still too", async () => {
  const board = connect(bench);
  const draw = vi.fn();
  stream.client.feeds.open({ mode: "roll", signals: ["a"], window_ms: 1, width: 2 }, draw);
  board.frame({ a: () => 1 }, { head: 10 });
  stream.client.feeds.draw();
  expect(draw).toHaveBeenCalledTimes(1);
  await board.events(events.slice(0, 1));
  stream.client.feeds.draw();
  expect(draw).toHaveBeenCalledTimes(2);
  board.status({ faults: [{ name: "added_mass", severity: 0.05, since_tick: 3 }] as never });
  stream.client.feeds.draw();
  expect(draw).toHaveBeenCalledTimes(3);
  board.status({ tick: 11 });
  stream.client.feeds.draw();
  expect(draw).toHaveBeenCalledTimes(3);
});

it("asks for the events it has missed", async () => {
  const board = connect(bench);
  await board.events(events.slice(0, 4));
  board.hello(bench, { last_event: events[3].seq });
  expect(board.of("resume")).toEqual([]);
  board.hello(bench, { last_event: 10 });
  expect(board.of("resume")).toEqual([{ type: "resume", after: events[3].seq }]);
});

it("keeps the events after a break, and forgets them when the server has begun anew", async () => {
  const board = connect(bench);
  await board.events(events);
  board.hello(bench);
  expect(now().events).toHaveLength(events.length);
  board.hello(bench, { server: "another" });
  expect(now().events).toEqual([]);
});

it("forgets scores and events when a fault is hidden, and says that it is", async () => {
  const board = connect(bench);
  board.status({ scores: status.scores });
  await board.events(events);
  board.hello({ ...bench, blind: { id: "question-1" } as never });
  expect(now().blind).toBe(true);
  expect(now().scores).toEqual({});
  expect(now().events).toEqual([]);
});

it("shows nothing of the bench before once another is opened, unless it is to stay in sight", () => {
  const board = connect(bench);
  board.status({ scores: status.scores });
  act(() => stream.open("next", true));
  expect(now().bench?.id).toBe(bench.id);
  act(() => stream.open("next"));
  expect(now().bench).toBeUndefined();
  expect(now().scores).toEqual({});
});

it("says what the server says of the connection", () => {
  const board = connect(bench);
  board.say({ type: "notice", code: "slow", message: "Frames are left out." } as never);
  expect(now().notice).toEqual({ code: "slow", message: "Frames are left out." });
  board.say({ type: "notice", code: "ask_me", message: "" } as never);
  expect(now().called).toBe(1);
  expect(now().notice?.code).toBe("slow");
});

it("says why the server refused a message, and subscribes on", () => {
  const board = connect(bench);
  board.say({
    type: "error",
    error: { code: "wrong", message: "No such signal.", field: "signals", hint: "" },
  } as never);
  expect(now().notice).toEqual({ code: "wrong", message: "No such signal." });
  expect(vi.mocked(console.error)).toHaveBeenCalledTimes(1);
  vi.mocked(console.error).mockClear();
});

it("counts refusals of a bench behind, and is silent of hidden signals", () => {
  server.on("GET", "/benches", { benches: [] }); // the benches behind are looked at again
  const board = connect({ ...bench, blind: { id: "question-1" } as never });
  const refuse = (field: string) =>
    board.say({ type: "error", error: { code: "wrong", message: "No.", field, hint: "" } } as never);
  refuse("signals");
  refuse("behind.0");
  expect(now().behindRefused).toBe(1);
  expect(now().notice).toBeUndefined();
});

it("asks for the cards of the units once their texts have changed", async () => {
  server.on("GET", "/benches/:id", { ...bench, units: [] });
  const board = connect(bench);
  board.status({ parameters: { ...bench.parameters, units: { twice: { source: "x" } } } });
  await vi.waitFor(() => expect(server.asked("GET", "/benches/first-look")).toHaveLength(1));
  board.status({ parameters: { ...bench.parameters, units: { twice: { source: "x" } } } });
  expect(server.asked("GET", "/benches/first-look")).toHaveLength(1);
});

it("ends the stream before when another one takes its place", async () => {
  const before = connect(bench);
  const waits = stream.client.command({ kind: "pause" });
  const ended = stream;
  const board = connect({ ...bench, id: "other" });
  await expect(waits).rejects.toThrow("The page left this bench.");
  ended.client.send({ type: "pong" });
  expect(before.isOpen).toBe(false);
  expect(before.of("pong")).toEqual([]);
  expect(useBench.getState().bench).toMatchObject({ id: "other", state: "paused" });
  board.status({ state: "running" });
  expect(useBench.getState().bench?.state).toBe("running");
});

it.each([1, 2])("begins test %i without a bench", (number) => {
  expect(useBench.getState().bench).toBeUndefined();
  connect({ ...bench, id: `b${number}` });
});
