import { screen, waitFor } from "@testing-library/react";
import { useState } from "react";
import { beforeEach, expect, it } from "vitest";
import { type ScopeConfig, scopeConfig } from "../../stream/scope-config";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce, resize } from "../../testing/jsdom-gaps";
import { recordedBench } from "../../testing/recorded";
import { penOf, pixelsOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { TRACE_COLOURS } from "../../ui/palette";
import { traceStyle } from "../../ui/trace-style";
import { ScopePanel } from "./scope-panel";

const { bench, frames } = await recordedBench("first-look");
const SIGNALS = ["plant.displacement", "sensor.displacement"];
const [DISPLACEMENT] = SIGNALS;
const colourOf = (name: string) =>
  TRACE_COLOURS.dark[
    traceStyle(
      name,
      bench.signals.map((s) => s.name),
      bench.diagnosers.kalman.names,
    ).slot
  ];

beforeEach(() => server.on("GET", "/benches/:id/printed", { marks: [] }));

function Scope({ config }: { config: ScopeConfig }) {
  const [kept, keep] = useState(config);
  return <ScopePanel config={kept} onChange={keep} />;
}

/** A scope of a bench with a board behind it. */
function mountScope(signals: string[], rest: Partial<ScopeConfig> = {}) {
  const board = connect(bench);
  const shown = mount(<Scope config={scopeConfig(signals, rest)} />);
  return { board, ...shown, pen: () => penOf(screen.getByRole("region", { name: /^Scope/ })) };
}

it("subscribes for as many columns as it has pixels, and again when it gets another size", () => {
  const { board } = mountScope([DISPLACEMENT], { windowMs: 20 });
  const [{ width, ...asked }] = board.subscriptions;
  expect(asked).toEqual({ mode: "roll", signals: [DISPLACEMENT], window_ms: 20 });
  expect(width).toBeLessThan(800);
  resize(500, 300);
  expect(board.subscriptions.map((one) => one.width)).toEqual([width - 300]);
});

it("is silent while its panel is hidden", () => {
  const { board, show } = mountScope([DISPLACEMENT]);
  show(false);
  expect(board.subscriptions).toEqual([]);
  show(true);
  expect(board.subscriptions).toHaveLength(1);
});

it("paints two recorded traces in their colours", async () => {
  const { board, pen } = mountScope(SIGNALS);
  board.replay(frames.scope);
  await drawOnce();
  for (const signal of SIGNALS) {
    const inked = pen().lines(colourOf(signal)).length + pixelsOf(pen().images[0], colourOf(signal));
    expect(inked, signal).toBeGreaterThan(0);
  }
  expect(board.of("ack")).toEqual([{ type: "ack", frame: 1 }]);
});

it.each([0.001, 0.37, 1, 4.2, 950])("never has one tick alone on an axis, as with an amplitude of %d", async (size) => {
  const { board, pen } = mountScope([DISPLACEMENT]);
  board.frame({ [DISPLACEMENT]: (tick) => size * (1 + 0.02 * Math.sin(tick / 9)) }, { head: 400 });
  await drawOnce();
  const labels = pen().texts.filter(({ text }) => /\d/.test(text));
  const upright = labels.filter(({ align }) => align === "right");
  expect(upright.length).toBeGreaterThan(1);
  expect(new Set(upright.map(({ text }) => text)).size).toBe(upright.length);
  expect(labels.length - upright.length).toBeGreaterThan(1);
});

it("has decades on a logarithmic scale", async () => {
  const { board, pen } = mountScope([DISPLACEMENT], { log: true });
  board.frame({ [DISPLACEMENT]: (tick) => 10 ** (-3 + (4 * tick) / 400) }, { head: 400 });
  await drawOnce();
  expect(pen().words).toContain("log");
  expect(pen().words.map((word) => word.replace(/\s/, " "))).toEqual(
    expect.arrayContaining(["10 nm", "100 nm", "1 µm"]),
  );
});

it("shows the past when a key pans, and live again with L", async () => {
  const { board, user } = mountScope([DISPLACEMENT]);
  board.frame({ [DISPLACEMENT]: Math.sin }, { head: 1000 });
  await drawOnce();
  expect(screen.getByText("PAUSED")).toBeVisible();
  screen.getByRole("group", { name: /^Plot/ }).focus();
  await user.keyboard("{ArrowLeft}");
  await waitFor(() => expect(board.subscriptions[0]).toMatchObject({ mode: "frozen", start_tick: 550, end_tick: 950 }));
  expect(screen.getByRole("button", { name: "PAST → LIVE" })).toBeVisible();
  await user.keyboard("l");
  expect(board.subscriptions[0].mode).toBe("roll");
});

it("keeps the focus where the key was pressed that led back to now", async () => {
  const { board, user } = mountScope([DISPLACEMENT]);
  board.frame({ [DISPLACEMENT]: Math.sin }, { head: 1000 });
  await drawOnce();
  screen.getByRole("group", { name: /^Plot/ }).focus();
  await user.keyboard("{ArrowLeft}");
  (await screen.findByRole("button", { name: "PAST → LIVE" })).focus();
  await user.keyboard("{Enter}");
  expect(await screen.findByText("PAUSED")).toHaveFocus();
});

it("says where there are no data", async () => {
  const { board, pen } = mountScope([DISPLACEMENT]);
  board.frame({ [DISPLACEMENT]: () => Number.NaN }, { head: 400 });
  await drawOnce();
  expect(pen().words).toContain("No data here: the bench has dropped it, or has not come to it yet");
});
