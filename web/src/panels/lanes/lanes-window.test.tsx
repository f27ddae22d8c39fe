import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import type { Bench, Command, LogEntry } from "../../api/types";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { logEntry } from "../../testing/log-entry";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { besideEstimate } from "../../testing/weighted";
import { CANVAS } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { LanesPanel } from "./lanes-panel";

const recorded = await recordedBench("seven-steps");
const catalog = await recordedAnswer("catalog");
const { recordings } = await recordedAnswer("recordings");
const END = 9000;
const { pending } = recorded.bench;
const steps = [...new Set(pending.map(({ tick }) => tick ?? 0))];
const bench = { ...recorded.bench, tick: 0, state: "running" as const };
const opened = recorded.events.filter(({ tick, actor }) => tick === 0 && actor === "scenario");

beforeEach(() => void server.on("GET", "/catalog", catalog));

const waiting = (tick: number) => pending.filter((one) => (one.tick ?? 0) >= tick);
/** The log of the steps up to a tick. */
const log = (tick: number): LogEntry[] =>
  pending.flatMap(({ tick: at, command }, i) =>
    (at ?? 0) < tick
      ? [logEntry({ seq: 100 + i, tick: at ?? 0, kind: "inject", actor: "scenario", command: command as Command })]
      : [],
  );

async function mountLanes(of: Bench) {
  const board = connect(of);
  const { user } = mount(<LanesPanel />);
  await waitFor(() => expect(besideEstimate(board.subscriptions)).toHaveLength(1));
  const windowMs = () => {
    const [asked] = besideEstimate(board.subscriptions);
    return asked.mode === "roll" ? asked.window_ms : undefined;
  };
  /** Where the stretches of the truth begin, and where the last ends, in shares of the field. */
  const truth = async (head: number) => {
    const { names } = bench.diagnosers.kalman;
    const now = (tick: number) => steps.filter((step) => step <= tick).length % names.length;
    const values = Object.fromEntries(
      besideEstimate(board.subscriptions)[0].signals.map((signal) => [signal, () => 0]),
    );
    board.frame({ ...values, "kalman.winner": now, "kalman.truth": now }, { head });
    await drawOnce();
    const pen = penOf(screen.getByRole("img", { name: /^Probability of/ }));
    const [foot] = pen.rects(CANVAS.dark.axis);
    const share = (x: number) => (x - foot.left) / (foot.right - foot.left);
    const y = pen.texts.find(({ text }) => text === "truth")?.points[0][1] ?? Number.NaN;
    const colours = names.map((_, i) => traceColour(hypothesisStyle(i), "dark"));
    const bands = pen.rects().filter(({ top, bottom, colour }) => top <= y && y <= bottom && colours.includes(colour));
    return [...bands.map(({ left }) => share(left)), share(bands[bands.length - 1].right)];
  };
  return { board, user, windowMs, truth };
}

it("shows each step while the scenario runs, also while a step is taken that the log does not have yet", async () => {
  const { board, windowMs } = await mountLanes(bench);
  await board.events([...opened, ...log(2001)]);
  board.status({ tick: 2001, pending: waiting(2001) });
  await waitFor(() => expect(windowMs()).toBe(50));
  board.status({ tick: 3001, pending: waiting(3001) });
  expect(windowMs()).toBe(50);
  await board.events(log(3001));
  expect(windowMs()).toBe(50);
});

it("holds the whole run once it has ended, with all steps, and while a step is replayed", async () => {
  const { board, windowMs, truth } = await mountLanes(bench);
  await board.events([...opened, ...log(END)]);
  board.status({ tick: END, pending: [], state: "paused" });
  await waitFor(() => expect(windowMs()).toBe(180));
  expectNear(
    await truth(END),
    [0, ...steps, END].map((tick) => tick / END),
  );
  expect(screen.getByRole("combobox", { name: "Time window" })).toHaveDisplayValue(/^180\sms$/);

  await board.events([logEntry({ seq: 200, tick: 1990, kind: "reset", actor: "page" }), ...opened.map(again)]);
  board.status({ tick: 2500, pending: waiting(2500), state: "running" });
  expectNear(
    await truth(2500),
    [0, steps[0], 2500].map((tick) => tick / END),
  );
  expect(windowMs()).toBe(180);
});

const expectNear = (shares: number[], wanted: number[]) => {
  expect(shares).toHaveLength(wanted.length);
  for (const [i, share] of shares.entries()) expect(share).toBeCloseTo(wanted[i], 1);
};
const again = (event: LogEntry): LogEntry => ({ ...event, seq: event.seq + 200 });

it("holds the whole of a recording while it plays", async () => {
  server.on("GET", "/recordings/:id", { ...recordings[0], start_tick: 1000, ticks: 6000 });
  const { windowMs, truth } = await mountLanes({ ...bench, replay_of: "recording-first", tick: 1000 });
  await waitFor(() => expect(windowMs()).toBe(120));
  expectNear(
    await truth(4000),
    [0, 2000, 3000, 4000].map((tick) => (tick - 1000) / 6000),
  );
});

it("keeps a window that is chosen by hand", async () => {
  const { board, user, windowMs } = await mountLanes({ ...bench, tick: END, pending: [] });
  await board.events([...opened, ...log(END)]);
  await waitFor(() => expect(windowMs()).toBe(180));
  await user.selectOptions(screen.getByRole("combobox", { name: "Time window" }), "10");
  expect(windowMs()).toBe(10);
});
