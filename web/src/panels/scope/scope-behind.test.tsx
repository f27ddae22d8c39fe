import { act, screen, within } from "@testing-library/react";
import { useState } from "react";
import { beforeEach, expect, it, vi } from "vitest";
import type { PrintedMark, Trace } from "../../api/types";
import { useBehind } from "../../bench/behind";
import { type ScopeConfig, scopeConfig } from "../../stream/scope-config";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { faded, TRACE_COLOURS } from "../../ui/palette";
import { traceStyle } from "../../ui/trace-style";
import { ScopePanel } from "./scope-panel";

const { bench } = await recordedBench("first-look");
const { claims } = await recordedAnswer("claims");
const SIGNAL = "plant.displacement";
const colour =
  TRACE_COLOURS.dark[
    traceStyle(
      SIGNAL,
      bench.signals.map((s) => s.name),
      bench.diagnosers.kalman.names,
    ).slot
  ];
const printed: PrintedMark = {
  ...claims[0].marks[0],
  signal: SIGNAL,
  unit: "um",
  low: 0.5,
  high: 1,
  problem: "",
  words: "0.5 µm",
  from_tick: 0,
  until_tick: 4000,
};

beforeEach(() => server.on("GET", "/benches/:id/printed", { marks: [] }));

function mountScope(rest: Partial<ScopeConfig> = {}) {
  const board = connect(bench);
  function Scope() {
    const [config, keep] = useState(scopeConfig([SIGNAL], { windowMs: 2, ...rest }));
    return <ScopePanel config={config} onChange={keep} />;
  }
  return { board, ...mount(<Scope />), pen: () => penOf(screen.getByRole("region", { name: /^Scope/ })) };
}
const behind = (difference = false) =>
  act(() => useBehind.setState({ behind: [{ bench: "other", words: "The <other>", shift: -7 }], difference }));

it("subscribes to a bench behind with its shift, and paints its trace faded beneath the live one", async () => {
  const { board, pen } = mountScope({ windowMs: 0.2 });
  behind();
  expect(board.subscriptions[0].behind).toEqual([{ bench: "other", shift_ticks: -7 }]);
  board.frame({ [SIGNAL]: Math.sin, [`other/${SIGNAL}`]: Math.cos }, { head: 1000 });
  await drawOnce();
  expect(screen.getByText("Behind, faded: The <other>.")).toBeVisible();
  const order = pen()
    .lines()
    .map((line) => line.colour);
  expect(order).toContain(faded(colour, "dark"));
  expect(order.lastIndexOf(faded(colour, "dark"))).toBeLessThan(order.indexOf(colour));
});

it("says that the difference is dotted", () => {
  mountScope();
  behind(true);
  expect(
    screen.getByText(/^Behind, faded: The <other>\. Dotted, on the axis Δ: the difference from The <other>/),
  ).toBeVisible();
});

it("draws what is printed, says where, and leaves it out when Printed is off", async () => {
  server.on("GET", "/benches/:id/printed", { marks: [printed] });
  const { board, user, pen } = mountScope();
  const box = await screen.findByRole("checkbox", { name: "Printed" });
  expect(screen.getByText(/^“0\.5\sµm” \(figure 5\.2\.4\.1\.4, section 5\.2\.4\.1\)$/)).toBeVisible();
  board.frame({ [SIGNAL]: Math.sin }, { head: 1000 });
  await drawOnce();
  const marked = pen().marks.length;
  await user.click(box);
  await drawOnce();
  expect(pen().marks.length).toBeLessThan(marked);
  expect(screen.queryByText(/section 5/)).not.toBeInTheDocument();
  await user.click(box);
  await drawOnce();
  expect(pen().marks.length).toBe(marked);
});

it("asks for nothing printed while a fault is hidden", () => {
  connect({ ...bench, blind: { id: "question-1" } as never });
  mount(<ScopePanel config={scopeConfig([SIGNAL])} onChange={() => undefined} />);
  expect(server.requests).toEqual([]);
});

it("measures at the cursors and over the span, with units", async () => {
  const wave = Array.from({ length: 200 }, (_, i) => 3 * Math.sin((2 * Math.PI * i) / 50));
  server.on("GET", "/benches/:id/trace", {
    start_tick: 800,
    end_tick: 1000,
    dt_ms: 0.01,
    signals: { [SIGNAL]: { min: wave, max: wave } },
  } satisfies Trace);
  const { board, user } = mountScope();
  board.frame({ [SIGNAL]: (tick) => tick / 1000 }, { head: 1000 });
  await drawOnce();
  await user.click(screen.getByRole("button", { name: "Tools" }));
  await user.click(await screen.findByRole("menuitem", { name: /^Measure/ }));
  await drawOnce();
  const strip = within(await screen.findByRole("region", { name: "Measurements" }));
  const cells = strip.getAllByRole("cell").map((cell) => cell.textContent?.replace(/\s/g, " "));
  expect(cells[0]).toMatch(/^(0\.850|850\.?\d*) [µn]m$/);
  expect(cells[1]).toMatch(/^(0\.950|950\.?\d*) [µn]m$/);
  expect(cells[2]).toMatch(/^100\.?\d* nm$/);
  expect(cells[3]).toMatch(/^2\.12\d? µm$/);
  expect(cells[4]).toMatch(/^2\.99\d µm$/);
  expect(cells[5]).toMatch(/^2\.00\d? kHz$/);
  expect(strip.getByRole("columnheader", { name: /^Δt\s1\.00\d?\sms/ })).toBeVisible();
  screen.getByRole("slider", { name: "Cursor A" }).focus();
  await user.keyboard("{ArrowRight}");
  expect(screen.getByRole("slider", { name: "Cursor A" })).toHaveAttribute("aria-valuenow", "26");
  const [asked] = server.asked("GET", "/benches/first-look/trace");
  expect(asked.query).toMatchObject({ signals: SIGNAL, start_tick: "800", end_tick: "1000" });
});

it("keeps names without room behind a button", async () => {
  vi.spyOn(HTMLElement.prototype, "offsetWidth", "get").mockReturnValue(300);
  const names = [SIGNAL, "sensor.displacement", "drive.voltage", "model.displacement"];
  connect(bench);
  const { user } = mount(<ScopePanel config={scopeConfig(names)} onChange={() => undefined} />);
  await user.click(screen.getByRole("button", { name: /^\+\d$/ }));
  const others = await screen.findByRole("list", { name: "Other signals" });
  expect(within(others).getAllByRole("listitem").at(-1)).toHaveTextContent(/model.*displacement/);
});
