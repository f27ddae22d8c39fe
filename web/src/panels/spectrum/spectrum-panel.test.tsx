import { screen } from "@testing-library/react";
import { expect, it, vi } from "vitest";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { SpectrumPanel } from "./spectrum-panel";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
/** A sine of 10 V at 2 kHz. */
const TONE = { "reference.voltage": (tick: number) => 10 * Math.sin(2 * Math.PI * 2 * tick * bench.dt_ms) };

async function mountPanel(signal: string) {
  const board = connect(bench);
  const { user } = mount(<SpectrumPanel />);
  const choose = (label: string, value: string) =>
    user.selectOptions(screen.getByRole("combobox", { name: label }), value);
  await choose("Signal", signal);
  return { board, choose, pen: () => penOf(screen.getByRole("img")) };
}

it("begins with the sensor, and subscribes to every tick of its record", () => {
  const board = connect(bench);
  mount(<SpectrumPanel />);
  expect(board.subscriptions).toEqual([
    { mode: "roll", signals: ["sensor.displacement"], window_ms: 4096 * bench.dt_ms, width: 4096 },
  ]);
  expect(screen.getByText(/^bins of 24\.4\sHz, Hann window$/)).toBeVisible();
});

it("begins with the sensor of x on a gyroscope", () => {
  const board = connect(gyroscope.bench);
  mount(<SpectrumPanel />);
  expect(board.subscriptions[0].signals).toEqual(["sensor.x.displacement"]);
});

it("finds the tone of the drive", async () => {
  const { board } = await mountPanel("reference.voltage");
  board.frame(TONE, { head: 9000 });
  await drawOnce();
  expect(screen.getByText(/^Strongest: 10\.0\sV at 2\.000\skHz$/)).toBeVisible();
});

it("has frequency in kHz across, and amplitudes with their unit upwards", async () => {
  const { board, pen } = await mountPanel("reference.voltage");
  board.frame(TONE, { head: 9000 });
  await drawOnce();
  expect(pen().words).toEqual(expect.arrayContaining(["frequency, kHz", "amplitude"]));
  const decades = pen().texts.flatMap(({ text, align }) => (align === "right" ? text.replace(/\s/g, " ") : []));
  expect(decades).toEqual(expect.arrayContaining(["10 V", "1 V", "100 mV"]));
  const numbers = () =>
    pen().texts.flatMap(({ text, align }) => (align === "center" && /^\d+$/.test(text) ? Number(text) : []));
  expect(Math.max(...numbers())).toBe(10); // a fifth of the whole band, which ends at 50 kHz
});

it("reaches up to the band that is chosen", async () => {
  vi.useFakeTimers({ toFake: ["performance"] });
  const { board, choose, pen } = await mountPanel("reference.voltage");
  await choose("Band", "1");
  await choose("Length of the record", "1024");
  expect(board.subscriptions[0]).toMatchObject({ width: 1024, window_ms: 1024 * bench.dt_ms });
  board.frame(TONE, { head: 9000 });
  vi.advanceTimersByTime(100);
  await drawOnce();
  expect(pen().words).toContain("50");
});

it("says that nothing moves", async () => {
  const { board } = await mountPanel("reference.voltage");
  board.frame({ "reference.voltage": () => 0 }, { head: 9000 });
  await drawOnce();
  expect(screen.getByText("Nothing moves.")).toBeVisible();
});
