import { fireEvent, screen, within } from "@testing-library/react";
import { useState } from "react";
import { beforeEach, expect, it } from "vitest";
import { type ScopeConfig, scopeConfig } from "../../stream/scope-config";
import type { CaptureMark } from "../../stream/wire";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { ScopePanel } from "./scope-panel";

const { bench } = await recordedBench("first-look");
const SIGNAL = "plant.displacement";
const captures = [1000, 1100, 1200].map(
  (tick): CaptureMark => ({ tick, trigger_tick: tick - 0.5, start_tick: tick - 20, end_tick: tick + 180 }),
);

beforeEach(() => server.on("GET", "/benches/:id/printed", { marks: [] }));

function Scope() {
  const [config, keep] = useState<ScopeConfig>(scopeConfig([SIGNAL], { windowMs: 2, mode: "triggered" }));
  return <ScopePanel config={config} onChange={keep} />;
}

/** A triggered scope with three captures. */
async function mountScope() {
  const board = connect({ ...bench, tick: 2000 });
  const { user } = mount(<Scope />);
  board.frame({ [SIGNAL]: Math.sin }, { head: 2000, triggerTick: 1500 });
  await drawOnce();
  const tell = (told = captures, rest: { is_short?: boolean } = {}) => {
    const panel = board.of("subscribe").at(-1)?.panel ?? 0;
    board.say({ type: "captures", panel, captures: told, most: 50, is_short: false, ...rest });
  };
  tell();
  return { board, user, tell };
}

const strip = () => within(screen.getByRole("group", { name: "Captures" }));
const words = () => strip().getByRole("status");
const press = (name: string) => strip().getByRole("button", { name: `${name} capture` });
const standsOn = (index: number) =>
  expect(words()).toHaveTextContent(
    `capture ${index + 1} of 3 at ${(captures[index].trigger_tick * bench.dt_ms).toFixed(3)}`,
  );

it("says how many captures are kept", async () => {
  const { tell } = await mountScope();
  expect(words()).toHaveTextContent("3 captures kept");
  tell([]);
  expect(words()).toHaveTextContent("no captures yet");
  expect(press("Previous")).toBeDisabled();
  tell(captures, { is_short: true });
  expect(words()).toHaveTextContent("3 captures kept, all that memory has room for");
});

it("goes to the newest, back one by one, and stays at the ends", async () => {
  const { board, user } = await mountScope();
  expect(press("Next")).toBeDisabled();
  await user.click(press("Previous"));
  standsOn(2);
  expect(press("Next")).toBeDisabled();
  expect(press("Newest")).toBeDisabled();
  expect(board.subscriptions[0]).toMatchObject({ mode: "frozen", start_tick: 1180, end_tick: 1380 });
  await user.click(press("Previous"));
  await user.click(press("Previous"));
  standsOn(0);
  expect(press("Previous")).toBeDisabled();
  await user.click(press("Next"));
  standsOn(1);
  await user.click(press("Newest"));
  standsOn(2);
});

it("goes through the captures by keys, and is live again with L", async () => {
  const { board, user } = await mountScope();
  screen.getByRole("group", { name: /^Plot\..*go through the captures/ }).focus();
  await user.keyboard("{PageUp}");
  standsOn(2);
  await user.keyboard("{PageUp}");
  standsOn(1);
  await user.keyboard("{PageDown}");
  standsOn(2);
  await user.keyboard("{PageUp}{PageUp}{End}");
  standsOn(2);
  expect(screen.getByRole("button", { name: "PAST → LIVE" })).toBeVisible();
  await user.keyboard("l");
  expect(words()).toHaveTextContent("3 captures kept");
  expect(board.subscriptions[0].mode).toBe("triggered");
});

it("goes to any capture under the hand, and stays on it while it is zoomed", async () => {
  const { board, user } = await mountScope();
  fireEvent.change(strip().getByRole("slider", { name: "Capture" }), { target: { value: "0" } });
  standsOn(0);
  board.frame({ [SIGNAL]: Math.sin }, { head: 2000 });
  await drawOnce();
  screen.getByRole("group", { name: /^Plot/ }).focus();
  for (let i = 0; i < 12; i += 1) await user.keyboard("+");
  standsOn(0);
});

it("leaves a capture of another trigger", async () => {
  const { board, user, tell } = await mountScope();
  await user.click(press("Previous"));
  await user.click(screen.getByRole("button", { name: /^[●○]? ?.*↗/ }));
  await user.clear(screen.getByLabelText("Level"));
  await user.type(screen.getByLabelText("Level"), "5");
  tell([]);
  expect(words()).toHaveTextContent("no captures yet");
  expect(board.subscriptions[0]).toMatchObject({ mode: "triggered", trigger: { level: 5 } });
});

it("has no strip while it rolls", async () => {
  const { user } = await mountScope();
  await user.click(screen.getByRole("button", { name: "Tools" }));
  await user.click(await screen.findByRole("menuitem", { name: /roll again$/ }));
  expect(screen.queryByRole("group", { name: "Captures" })).not.toBeInTheDocument();
});
