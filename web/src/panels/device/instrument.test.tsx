import { screen } from "@testing-library/react";
import { expect, it } from "vitest";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { Instrument } from "./instrument";

const { bench } = await recordedBench("first-look");
const instrument = {
  source: "scope",
  is_connected: true,
  is_growing: true,
  ended: "",
  names: ["CH1", "CH2"],
  received_khz: 100,
  lag_ms: 12,
  latency_p95_ms: 21,
  record: "0f",
  samples: 2000,
  blocks: 20,
  lost_blocks: 3,
  late_blocks: 1,
  doubled_blocks: 2,
  lost_samples: 300,
  breaks: 0,
};

const value = (name: string) => screen.getByText(name).nextElementSibling;

it("is absent on a bench without an instrument", () => {
  connect(bench);
  mount(<Instrument />);
  expect(screen.queryByRole("region", { name: "Instrument" })).toBeNull();
});

it("shows rate, lag and what was lost", () => {
  connect({ ...bench, instrument });
  mount(<Instrument />);
  expect(screen.getByRole("heading", { name: "scope, live" })).toBeVisible();
  expect(value("Rate")).toHaveTextContent("100 kHz");
  expect(value("Lag")).toHaveTextContent("12 ms");
  expect(value("Verdict after")).toHaveTextContent("21 ms");
  expect(value("Lost blocks")).toHaveTextContent("3");
  expect(value("Lost blocks")).toHaveAttribute("data-lost", "true");
  expect(value("Breaks")).toHaveAttribute("data-lost", "false");
  expect(screen.queryByRole("status")).toBeNull();
});

it("says that the instrument is gone, and that the record has ended", () => {
  const board = connect({ ...bench, instrument });
  mount(<Instrument />);
  board.status({ instrument: { ...instrument, is_connected: false } });
  expect(screen.getByRole("status")).toHaveTextContent("It is gone; the bench waits.");
  const ended = "the record of instrument scope ends at sample 2000: the server was stopped";
  board.status({ instrument: { ...instrument, is_connected: false, is_growing: false, ended } });
  expect(screen.getByRole("status")).toHaveTextContent(`The record of instrument scope ends at sample 2000`);
});
