import { screen } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { BoardView, DeviceView, EnvironmentView } from "./device-panel";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");
const plants = [
  { name: "linear", ns_per_tick: 2000, refused: "" },
  { name: "planar", ns_per_tick: null, refused: "the device has no beams" },
];

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/benches/:id/plants", { plants });
});

function mountPanel(of = bench, view = <EnvironmentView />) {
  const board = connect(of);
  const { user } = mount(view);
  const enter = async (label: string, value: string) => {
    await user.clear(screen.getByRole("textbox", { name: label }));
    await user.type(screen.getByRole("textbox", { name: label }), `${value}{Enter}`);
  };
  return { board, user, enter };
}

it.each([
  ["Temperature, K", "350", "temperature_k"],
  ["Pressure, Pa", "20000", "pressure_pa"],
  ["Relative humidity, %", "55", "humidity_pct"],
])("sends %s on Enter", async (label, value, name) => {
  const { board, enter } = mountPanel();
  await enter(label, value);
  expect(board.commands).toEqual([{ set: { [`environment.${name}`]: Number(value) } }]);
});

it("shows the air of the board, and the way back to usual air", async () => {
  const { board, user } = mountPanel();
  expect(screen.getByRole("textbox", { name: "Pressure, Pa" })).toHaveValue("101325");
  board.status({ parameters: { ...bench.parameters, environment: { pressure_pa: 20_000 } } });
  expect(screen.getByRole("textbox", { name: "Pressure, Pa" })).toHaveValue("20000");
  await user.click(screen.getByRole("button", { name: /^Pressure: back to/ }));
  expect(board.commands).toEqual([{ set: { "environment.pressure_pa": 101_325 } }]);
});

it("injects friction as the fault stiction, and heals it at 0", async () => {
  const { board, enter } = mountPanel();
  await enter("Friction dead band, nN", "12");
  expect(board.commands).toEqual([{ fault: "stiction", severity: 12, profile: { kind: "step" } }]);
  board.status({ faults: [{ ...bench.faults[0], name: "stiction", severity: 12 }] });
  expect(screen.getByRole("textbox", { name: "Friction dead band, nN" })).toHaveValue("12");
  await enter("Friction dead band, nN", "0");
  expect(board.commands[1]).toEqual({ heal: ["stiction"] });
});

it("refuses a negative friction in words, and sends nothing", async () => {
  const { board, enter } = mountPanel();
  await enter("Friction dead band, nN", "-1");
  expect(screen.getByRole("alert")).toHaveTextContent("at least 0");
  expect(board.commands).toEqual([]);
});

it("lists the plants with the cost of a tick, and says why one is not offered", async () => {
  mountPanel(bench, <DeviceView />);
  expect(await screen.findByText(/^2\.00\sµs per tick of the whole bench, 5\.00 times/)).toBeVisible();
  expect(screen.getByText("not on this bench: the device has no beams")).toBeVisible();
  expect(screen.getByRole("radio", { checked: true })).toHaveAttribute("value", "linear");
});

it("sends the plant that is chosen, and shows the words of a refusal", async () => {
  const { board, user } = mountPanel(bench, <DeviceView />);
  const planar = (await screen.findAllByRole("radio")).find((one) => one.getAttribute("value") === "planar");
  await user.click(planar as HTMLElement);
  expect(board.commands).toEqual([{ set: { "plant.model": "planar" } }]);
  await board.refuse("This device has no beams.");
  expect(screen.getByRole("alert")).toHaveTextContent("This device has no beams.");
  expect(planar).not.toBeChecked();
});

it("says that the cost is being measured while the server has not answered", async () => {
  server.on("GET", "/benches/:id/plants", new Refusal(503, "busy"));
  mountPanel(bench, <DeviceView />);
  expect((await screen.findAllByText("measuring its cost")).length).toBeGreaterThan(1);
});

it("says the known weaknesses of the plant in use", async () => {
  const weak = catalog.blocks.find((b) => b.family === "plant" && b.weaknesses.length > 0 && b.axes?.length === 0);
  mountPanel({ ...bench, parameters: { ...bench.parameters, plant: { model: weak?.name } } }, <DeviceView />);
  const notes = await screen.findAllByRole("note");
  expect(notes).toHaveLength(weak?.weaknesses.length as number);
  expect(notes[0]).toHaveTextContent(/^Known weakness/);
});

it("has temperature and no pressure around the package of a gyroscope", async () => {
  const { board, enter } = mountPanel(gyroscope.bench);
  expect(screen.getByRole("heading", { name: "Around the package" })).toBeVisible();
  expect(screen.queryByRole("textbox", { name: "Pressure, Pa" })).not.toBeInTheDocument();
  expect(screen.queryByRole("textbox", { name: /^Friction/ })).not.toBeInTheDocument();
  await enter("Temperature, K", "310");
  expect(board.commands).toEqual([{ set: { "environment.temperature_k": 310 } }]);
});

it.each([
  ["Delay samples", "2", "delay_samples"],
  ["Jitter, µs", "0.1", "jitter_us"],
  ["Slew, V/µs", "0.5", "slew_v_per_us"],
])("sets %s of the board while it runs", async (label, value, name) => {
  const { board, enter } = mountPanel(bench, <BoardView />);
  await screen.findByRole("heading", { name: "Filter and sampling" });
  await enter(label, value);
  expect(board.commands).toEqual([{ set: { [`board.${name}`]: Number(value) } }]);
});

it("changes values of several blocks of the board in one tick", async () => {
  const { board, enter, user } = mountPanel(bench, <BoardView />);
  await screen.findByRole("heading", { name: "Delay and amplifier" });
  await user.click(screen.getByRole("checkbox", { name: "Collect changes, apply them in one tick" }));
  await enter("Delay samples", "2");
  await enter("Antialias, kHz", "20");
  expect(board.commands).toEqual([]);
  await user.click(screen.getByRole("button", { name: "Apply 2 in one tick" }));
  expect(board.commands).toEqual([{ set: { "board.delay_samples": 2, "board.antialias_khz": 20 } }]);
});

it("has no slew in volts on a gyroscope", async () => {
  mountPanel(gyroscope.bench, <BoardView />);
  expect(await screen.findByRole("textbox", { name: /^Delay samples/ })).toBeVisible();
  expect(screen.queryByRole("textbox", { name: /^Slew/ })).not.toBeInTheDocument();
});
