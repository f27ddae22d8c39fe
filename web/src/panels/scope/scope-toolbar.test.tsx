import { act, screen, within } from "@testing-library/react";
import { useState } from "react";
import { beforeEach, expect, it, vi } from "vitest";
import { type ScopeConfig, scopeConfig } from "../../stream/scope-config";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { ScopePanel } from "./scope-panel";

const { bench } = await recordedBench("first-look");
const VOLTAGE = "drive.voltage";
const NAMES = ["plant.displacement", "plant.velocity", "reference.voltage", VOLTAGE, "kalman.winner"];
/** The bench with few signals: a list of all is long. */
const small = { ...bench, signals: bench.signals.filter(({ name }) => NAMES.includes(name)) };

beforeEach(() => server.on("GET", "/benches/:id/printed", { marks: [] }));

/** A scope, and the settings it was given last. */
function mountScope(signals = [VOLTAGE], rest: Partial<ScopeConfig> = {}) {
  const board = connect(small);
  let kept = scopeConfig(signals, rest);
  function Scope() {
    const [config, keep] = useState(kept);
    kept = config;
    return <ScopePanel config={config} onChange={keep} />;
  }
  return { board, ...mount(<Scope />), kept: () => kept };
}

it("sends the trigger on a press, and says where it stands", async () => {
  const { board, user } = mountScope();
  await user.click(screen.getByRole("button", { name: "Tools" }));
  await user.click(await screen.findByRole("menuitem", { name: /^Trigger/ }));
  expect(board.subscriptions[0]).toMatchObject({
    mode: "triggered",
    signals: [VOLTAGE],
    trigger: { level: 0, edge: "rising", sweep: "auto" },
  });
  board.frame({ [VOLTAGE]: Math.sin }, { head: 900, triggerTick: 700 });
  await drawOnce();
  expect(screen.getByRole("button", { name: /^● ↗ 0\sV$/ })).toBeVisible();
  board.frame({ [VOLTAGE]: Math.sin }, { head: 900, waiting: true });
  await drawOnce();
  expect(screen.getByRole("button", { name: /^○ waiting ↗ 0\sV$/ })).toBeVisible();
});

it.each([
  ["When it", "falling", { edge: "falling", upper: null }],
  ["When it", "enters", { edge: "enters", level: 0, upper: 1 }],
  ["Signal", "reference.voltage", { signal: "reference.voltage" }],
])("sends the trigger with another %s: %s", async (label, value, trigger) => {
  const { board, user } = mountScope([VOLTAGE], { mode: "triggered" });
  await user.click(screen.getByRole("button", { name: /↗/ }));
  await user.selectOptions(screen.getByLabelText(label), value);
  expect(board.subscriptions[0]).toMatchObject({ trigger });
});

it("sends level, hysteresis and position, in the unit of the signal", async () => {
  const { board, user } = mountScope([VOLTAGE], { mode: "triggered" });
  await user.click(screen.getByRole("button", { name: /↗/ }));
  for (const [label, value] of [
    ["Level", "2.5"],
    ["Hysteresis", "0.2"],
    ["Shown before the edge", "30"],
  ]) {
    await user.clear(screen.getByLabelText(label));
    await user.type(screen.getByLabelText(label), value);
  }
  expect(screen.getByLabelText("Level")).toHaveValue("2.5 V");
  expect(board.subscriptions[0]).toMatchObject({ trigger: { level: 2.5, hysteresis: 0.2, position: 0.3 } });
});

it("arms a single sweep again", async () => {
  const { board, user } = mountScope([VOLTAGE], { mode: "triggered" });
  await user.click(screen.getByRole("button", { name: /↗/ }));
  await user.click(screen.getByRole("radio", { name: "single" }));
  await user.click(screen.getByRole("button", { name: "Arm again" }));
  const [{ panel }] = board.of("subscribe");
  expect(board.of("rearm")).toEqual([{ type: "rearm", panel }]);
  expect(board.subscriptions[0]).toMatchObject({ trigger: { sweep: "single" } });
});

it("subscribes to another window of time", async () => {
  const { board, user } = mountScope([VOLTAGE], { windowMs: 4 });
  await user.selectOptions(screen.getByRole("combobox", { name: "Time window" }), "20");
  expect(board.subscriptions[0]).toMatchObject({ window_ms: 20 });
});

it("adds and removes signals, found by name or meaning", async () => {
  const { board, user, kept } = mountScope();
  await user.click(screen.getByRole("button", { name: "Choose signals" }));
  await user.type(screen.getByLabelText("Search signals"), "true displacement of");
  const found = within(screen.getByRole("dialog")).getAllByRole("checkbox");
  expect(found).toHaveLength(2); // the signal, and the logarithmic scale
  await user.click(found[1]);
  expect(kept().signals).toEqual([VOLTAGE, "plant.displacement"]);
  expect(board.subscriptions[0].signals).toEqual([VOLTAGE, "plant.displacement"]);
  await user.clear(screen.getByLabelText("Search signals"));
  await user.type(screen.getByLabelText("Search signals"), "no such thing");
  expect(screen.getByText("No signal of this bench matches.")).toBeVisible();
  await user.clear(screen.getByLabelText("Search signals"));
  await user.type(screen.getByLabelText("Search signals"), VOLTAGE);
  await user.click(screen.getByRole("checkbox", { name: "voltage · V" }));
  expect(board.subscriptions[0].signals).toEqual(["plant.displacement"]);
});

it("finds no verdict among the signals while a fault is hidden", async () => {
  const board = connect(small);
  const hidden = small.signals.filter(({ name }) => !name.startsWith("kalman."));
  board.hello({ ...small, signals: hidden, blind: { id: "question-1" } as never });
  const { user } = mount(<ScopePanel config={scopeConfig([VOLTAGE])} onChange={() => undefined} />);
  await user.click(screen.getByRole("button", { name: "Choose signals" }));
  await user.type(screen.getByLabelText("Search signals"), "winner");
  expect(screen.getByText("No signal of this bench matches.")).toBeVisible();
});

it("keeps the logarithmic scale", async () => {
  const { user, kept } = mountScope();
  await user.click(screen.getByRole("button", { name: "Choose signals" }));
  await user.click(screen.getByLabelText("Logarithmic scale, of magnitudes"));
  expect(kept().log).toBe(true);
});

it("shows the newest value of each signal with its unit", async () => {
  const { board } = mountScope([VOLTAGE, "plant.displacement"]);
  board.frame({ [VOLTAGE]: () => 9.5, "plant.displacement": () => -0.25 }, { head: 900 });
  await drawOnce();
  await drawOnce();
  const items = within(screen.getByRole("list", { name: "Signals" })).getAllByRole("listitem");
  expect(items[0]).toHaveTextContent(/9\.50*\sV$/);
  expect(items[1]).toHaveTextContent(/−(0\.250*\sµm|250(\.0+)?\snm)$/);
});

it("says that nothing is on it", () => {
  mountScope([]);
  expect(screen.getByText("Nothing on this scope")).toBeVisible();
});

it("says that its signals are hidden while a fault is, and no longer after the answer", () => {
  const board = connect(small);
  const hidden = small.signals.filter(({ name }) => name !== VOLTAGE);
  board.hello({ ...small, signals: hidden, blind: { id: "question-1" } as never });
  mount(<ScopePanel config={scopeConfig([VOLTAGE])} onChange={() => undefined} />);
  expect(screen.getByText("Hidden until you answer")).toBeVisible();
  act(() => board.hello(small));
  expect(screen.queryByText("Hidden until you answer")).not.toBeInTheDocument();
});

it("says that a band is the envelope of a fast tone, and no longer in a short window", async () => {
  vi.useFakeTimers({ toFake: ["performance"] });
  const { board, user } = mountScope([VOLTAGE], { windowMs: 500 });
  board.frame({ [VOLTAGE]: (tick) => 10 * Math.sin(tick / 3) }, { head: 60_000 });
  await drawOnce();
  vi.advanceTimersByTime(300);
  await drawOnce();
  const note = screen.getByRole("note");
  expect(note).toHaveAccessibleName(/^envelope: Each pixel takes [\d.]+\s[µm]s, \d+\ssamples\. .*: drive voltage\./);
  await user.selectOptions(screen.getByRole("combobox", { name: "Time window" }), "4");
  board.frame({ [VOLTAGE]: (tick) => 10 * Math.sin(tick / 3) }, { head: 60_000 });
  await drawOnce();
  vi.advanceTimersByTime(300);
  await drawOnce();
  expect(screen.queryByRole("note")).not.toBeInTheDocument();
});
