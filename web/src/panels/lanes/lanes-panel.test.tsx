import { screen } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useView } from "../../bench/view-store";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { besideEstimate } from "../../testing/weighted";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { LanesPanel } from "./lanes-panel";

const { bench, status, events, frames } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const { names } = bench.diagnosers.kalman;
const colourOf = (name: string) => traceColour(hypothesisStyle(names.indexOf(name)), "dark");

beforeEach(() => server.on("GET", "/catalog", catalog));

/** The lanes of the bank, as it was recorded. */
async function mountLanes() {
  const board = connect(bench);
  board.status(status);
  const shown = mount(<LanesPanel />);
  await board.events(events);
  board.replay(frames.kalman);
  await drawOnce();
  return { board, ...shown, pen: () => penOf(screen.getByRole("img", { name: /^Probability of/ })) };
}

it("subscribes to the probabilities, the winner, the truth and what fits none", async () => {
  const { board } = await mountLanes();
  expect(besideEstimate(board.subscriptions).map(({ signals }) => signals)).toEqual([frames.kalman.signals]);
  expect(board.subscriptions.flatMap(({ signals }) => signals)).toContain("kalman.weighted.displacement");
});

it("fills a lane for each hypothesis, in its colour", async () => {
  const { pen } = await mountLanes();
  const lane = (name: string, alpha: string) => {
    const marks = pen().areas(colourOf(name) + alpha);
    expect(marks.length, name).toBe(1); // all columns together, which a processor draws soon
    return marks[0];
  };
  for (const name of names) lane(name, "d9");
  const tops = names.map((name) => Math.min(...lane(name, "66").points.map(([, y]) => y)));
  expect(tops).toEqual([...tops].sort((a, b) => a - b));
});

it("has the truth in a band below the verdict, both with the fault that acts at their ends", async () => {
  const { pen } = await mountLanes();
  const heightOf = (word: string) => pen().texts.find(({ text }) => text === word)?.points[0][1] ?? Number.NaN;
  const [verdict, truth] = [heightOf("verdict"), heightOf("truth")];
  expect(truth).toBeGreaterThan(verdict);
  const solid = pen()
    .rects(colourOf("m+5"))
    .filter(({ top, bottom }) => top <= truth && truth <= bottom);
  expect(solid).toHaveLength(1);
  const healthy = pen()
    .rects(colourOf("healthy"))
    .filter(({ top, bottom }) => top <= truth && truth <= bottom);
  expect(healthy[0].right).toBeCloseTo(solid[0].left, 0);
});

it("says how late the fault was found, as a text and between the bands", async () => {
  const { pen } = await mountLanes();
  const delay = screen.getByText("delay", { selector: "dt" }).nextElementSibling;
  expect(delay).toHaveTextContent("30 samples · 300 µs");
  expect(pen().words.some((word) => word.startsWith("30"))).toBe(true);
});

it("picks the newest sample to be explained", async () => {
  const { user } = await mountLanes();
  await user.click(screen.getByRole("button", { name: "Explain the newest sample" }));
  expect(useView.getState().sample).toEqual({ diagnoser: "kalman", tick: 1999 });
});

it("says that a bench has no diagnoser", () => {
  connect({ ...bench, diagnosers: {} });
  mount(<LanesPanel />);
  expect(screen.getByText("No diagnoser on this bench")).toBeVisible();
});
