import { act, screen, within } from "@testing-library/react";
import { useState } from "react";
import { beforeEach, expect, it, vi } from "vitest";
import type { LogEntry } from "../../api/types";
import { makeSlide } from "../../bench/change";
import { scopeConfig } from "../../stream/scope-config";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { jump } from "../../ui/hover";
import { faded, TRACE_COLOURS } from "../../ui/palette";
import * as files from "../../ui/save-file";
import { traceStyle } from "../../ui/trace-style";
import { ScopePanel } from "./scope-panel";

const { bench } = await recordedBench("first-look");
const { blocks } = await recordedAnswer("catalog");
const SIGNAL = "plant.displacement";
const names = bench.signals.map((s) => s.name);
const colour = TRACE_COLOURS.dark[traceStyle(SIGNAL, names, bench.diagnosers.kalman.names).slot];
const ghostly = faded(colour, "dark");
const CHANGE = bench.tick;

beforeEach(() => {
  server.on("GET", "/benches/:id/printed", { marks: [] });
  server.on("GET", "/catalog", { blocks });
});

const switched = (seq: number, tick: number, controller = "mrac") =>
  ({
    seq,
    tick,
    kind: "switch",
    actor: "page",
    text: `switch to ${controller}`,
    command: { switch: controller },
    old: "open_loop",
    new: controller,
    at: "2026-01-01T00:00:00Z",
  }) as unknown as LogEntry;

/** A sine of the drive that becomes four times smaller at the change. */
const wave = (tick: number) => (tick < CHANGE ? 2 : 0.5) * Math.sin((2 * Math.PI * tick) / 50);

function mountScope(shown = bench) {
  const board = connect(shown);
  function Scope() {
    const [config, keep] = useState(scopeConfig([SIGNAL], { windowMs: 4 }));
    return <ScopePanel config={config} onChange={keep} />;
  }
  const at = async (head: number, value: (tick: number) => number = wave) => {
    board.status({ tick: head });
    await drawOnce();
    board.frame({ [SIGNAL]: value }, { head });
    await drawOnce();
  };
  return { board, at, ...mount(<Scope />), pen: () => penOf(screen.getByRole("region", { name: /^Scope/ })) };
}

const strip = () => screen.queryByRole("region", { name: "Before and after" });
const said = () => strip()?.textContent?.replaceAll(/\s/g, " ");
const axis = (pen: ReturnType<typeof penOf>) =>
  pen.texts.filter(({ align }) => align === "right").map(({ text }) => text);

it("says the change and the figures before it, then those after it, settling until two windows agree", async () => {
  const { board, at } = mountScope();
  await at(CHANGE);
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE);
  expect(await screen.findByText("Switch to Direct MRAC")).toBeVisible();
  expect(said()).toMatch(/at 20\.000 ms/);
  expect(said()).toMatch(/before 1\.41 µm → now – RMS/);
  await at(CHANGE + 300);
  expect(said()).toMatch(/4\.0 times smaller, still settlingbefore 1\.41 µm → now 354 nm RMS/);
  await at(CHANGE + 1200);
  expect(said()).toMatch(/4\.0 times smallerbefore 1\.41 µm → now 354 nm RMS/);
  expect(said()).not.toMatch(/still settling/);
});

it("is still settling while the figure falls from window to window", async () => {
  const { board, at } = mountScope();
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE);
  await at(CHANGE + 1200, (tick) => Math.exp((CHANGE - tick) / 800) * Math.sin((2 * Math.PI * tick) / 50));
  expect(said()).toMatch(/times smaller, still settling/);
});

it("draws the last periods before the change faded, in phase, on an axis that holds both", async () => {
  const { board, at, pen } = mountScope();
  await at(CHANGE);
  const labels = axis(pen());
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE);
  await at(CHANGE + 1237);
  const [ghost, live] = [pen().lines(ghostly), pen().lines(colour)].map(([line]) => line.points);
  const top = (points: typeof ghost) => points.reduce((a, b) => (b[1] < a[1] ? b : a));
  const height = (points: typeof ghost) => {
    const ys = points.map(([, y]) => y);
    return Math.max(...ys) - Math.min(...ys);
  };
  expect(height(ghost) / height(live)).toBeCloseTo(4, 1);
  // the crests are whole periods apart: 400 ticks are 8 periods
  const width = Math.max(...live.map(([x]) => x)) - Math.min(...live.map(([x]) => x));
  const periods = ((top(ghost)[0] - top(live)[0]) / width) * (399 / 50);
  expect(Math.abs(periods - Math.round(periods))).toBeLessThan(0.02);
  expect(axis(pen())).toEqual(labels);
});

it("sees a noise that the RMS of the sine hides", async () => {
  const { board, at } = mountScope();
  const hiss = (tick: number) => ((tick * 7919) % 1009) / 1009 - 0.5;
  const noisy = (tick: number) => 2 * Math.sin((2 * Math.PI * tick) / 50) + (tick < CHANGE ? 0.1 : 0.4) * hiss(tick);
  await at(CHANGE, noisy);
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE, noisy);
  await at(CHANGE + 1200, noisy);
  // a uniform number of width 0.4 µm deviates by 0.4/√12
  expect(said()).toMatch(/noise 4\.0 times largerbefore 2\d\.\d nm → now 11\d nm noise/);
});

it("goes when it is dismissed, and with it the ghost", async () => {
  const { board, at, pen, user } = mountScope();
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE);
  await at(CHANGE + 1000);
  expect(pen().lines(ghostly)).not.toHaveLength(0);
  await user.click(screen.getByRole("button", { name: "Dismiss" }));
  await at(CHANGE + 1100);
  expect(strip()).not.toBeInTheDocument();
  expect(pen().lines(ghostly)).toHaveLength(0);
  expect(board.subscriptions.map(({ mode }) => mode)).toEqual(["roll"]);
});

it("compares the next change in its place, and goes when one seeks to before it", async () => {
  const { board, at } = mountScope();
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE);
  await at(CHANGE + 1000);
  await board.events([switched(21, CHANGE + 1000, "pid")]);
  await at(CHANGE + 1000);
  expect(said()).toMatch(/^Switch to PID.* at 30\.000 ms.*before 354 nm → now –/);
  act(() => jump.to({ tick: CHANGE + 900 }));
  expect(strip()).not.toBeInTheDocument();
});

it("says hidden, and shows neither ghost nor figure, while a fault is hidden", async () => {
  const { board, at, pen } = mountScope({ ...bench, blind: { id: "question-1" } as never });
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE);
  await at(CHANGE + 1000);
  const words = await screen.findByText("Before and after are hidden while a fault is hidden.");
  expect(words).toBeVisible();
  expect(said()).not.toMatch(/RMS|µm|nm/);
  expect(within(strip() as HTMLElement).queryByRole("button", { name: "Slide" })).not.toBeInTheDocument();
  expect(pen().lines(ghostly)).toHaveLength(0);
});

it("keeps the picture as a slide with the words, the ghost and the figures", async () => {
  const png = vi.spyOn(files, "pngOf").mockResolvedValue(new Blob());
  const saved = vi.spyOn(files, "saveFile").mockReturnValue();
  const { board, at } = mountScope();
  await board.events([switched(20, CHANGE)]);
  await at(CHANGE);
  await at(CHANGE + 1200);
  await screen.findByText("Switch to Direct MRAC");
  await act(async () => makeSlide());
  await vi.waitFor(() => expect(saved).toHaveBeenCalled());
  const slide = new DOMParser().parseFromString(png.mock.calls[0][0], "image/svg+xml");
  expect(slide.querySelector("parsererror")).toBeNull();
  const texts = [...slide.querySelectorAll("text")].map((node) => node.textContent?.replaceAll(/\s/g, " "));
  expect(texts).toEqual(
    expect.arrayContaining([
      "Switch to Direct MRAC",
      "plant displacement, RMS",
      "before 1.41 µm",
      "now 354 nm",
      "4.0 times smaller",
      "plant displacement (before)",
    ]),
  );
  expect(saved.mock.calls[0][0]).toMatch(/^first-look-.*-slide\.png$/);
});
