import { expect, it } from "vitest";
import { connect } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { useBench } from "./bench-store";
import { stream } from "./stream";

const { bench } = await recordedBench("first-look");

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
