import { act, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { scopeConfig } from "../../stream/scope-config";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { logEntry } from "../../testing/log-entry";
import { recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { ScopePanel } from "./scope-panel";

const { bench } = await recordedBench("first-look");
const SIGNAL = "plant.displacement";

beforeEach(() => {
  vi.useFakeTimers({ toFake: ["performance", "setTimeout", "clearTimeout"] });
  server.on("GET", "/benches/:id/printed", { marks: [] });
});
afterEach(() => vi.useRealTimers());

const scope = () => penOf(screen.getByRole("region", { name: /^Scope/ }));
const show = (signals: string[], of = bench) => {
  const board = connect(of);
  mount(<ScopePanel config={scopeConfig(signals)} onChange={() => undefined} />);
  return board;
};

it("fits the axis to what a paused board shows, without another frame", async () => {
  const board = show([SIGNAL]);
  const labels = () =>
    new Set(
      scope()
        .texts.filter(({ align }) => align === "right")
        .map(({ text }) => text),
    );
  board.frame({ [SIGNAL]: () => 80 }, { head: 400 });
  await drawOnce();
  board.frame({ [SIGNAL]: (tick) => Math.sin(tick / 9) }, { head: 900 });
  await drawOnce();
  expect(labels()).toContain("80");
  await act(() => vi.advanceTimersByTimeAsync(1300));
  await drawOnce();
  expect(labels()).not.toContain("80");
  expect(labels()).toContain("1.0");
});

it("shows each controller for the time it drove", async () => {
  const signals = [...bench.signals, { ...bench.signals[0], name: "pid.voltage", unit: "V", block: "pid" }];
  const board = show(["@active.voltage"], { ...bench, controller: "open_loop", signals });
  const driven = "open_loop.voltage";
  expect(board.subscriptions.at(-1)?.signals).toEqual([driven]);
  await board.events([logEntry({ seq: 40, tick: 300, kind: "switch", old: "open_loop", new: "pid" })]);
  board.status({ controller: "pid" } as never);
  await act(() => vi.advanceTimersByTimeAsync(100));
  expect(board.subscriptions.at(-1)?.signals).toEqual(["pid.voltage", driven]);
  board.frame({ "pid.voltage": () => 2, [driven]: () => 1 }, { head: 500 });
  await drawOnce();
  const spans = scope()
    .lines()
    .filter(({ width }) => width > 1)
    .map(({ points }) => points.map(([x]) => x))
    .map((xs) => [Math.min(...xs), Math.max(...xs)]);
  expect(spans).toHaveLength(2);
  expect(spans[0][0]).toBeGreaterThan(spans[1][0]);
});
