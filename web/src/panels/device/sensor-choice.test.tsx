import { screen } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { SensorChoice } from "./sensor-choice";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");
const withSensor = (kind: string) => ({ ...bench.parameters, sensor: { kind } });

beforeEach(() => server.on("GET", "/catalog", catalog));

/** The list of sensors, once the catalogue has come. */
async function list() {
  await screen.findAllByRole("option");
  return screen.getByRole<HTMLSelectElement>("combobox", { name: "Sensor that feeds the controllers" });
}
const bypass = () => screen.getByRole("button", { name: "Bypass" });
const kind = (name: string) => ({ set: { "sensor.kind": name } });

it("sends exactly one command for a choice, and keeps the choice before and after the answer", async () => {
  const board = connect(bench);
  const { user } = mount(<SensorChoice />);
  await user.selectOptions(await list(), "capacitive");
  expect(await list()).toHaveValue("capacitive");
  expect(bypass()).toHaveAttribute("aria-pressed", "false");
  board.status({ parameters: withSensor("capacitive") });
  await board.reply();
  expect(await list()).toHaveValue("capacitive");
  expect(board.commands).toEqual([kind("capacitive")]);
});

it("goes back to the sensor of the board when it refuses another", async () => {
  const board = connect(bench);
  const { user } = mount(<SensorChoice />);
  await user.selectOptions(await list(), "capacitive");
  await board.refuse("There is no such sensor here.");
  expect(await list()).toHaveValue("ideal");
  expect(screen.getByRole("alert")).toHaveTextContent("There is no such sensor here.");
});

it("means each of three fast choices from the choice before", async () => {
  const board = connect(bench);
  const { user } = mount(<SensorChoice />);
  await user.selectOptions(await list(), "capacitive");
  await user.dblClick(bypass());
  expect(board.commands).toEqual([kind("capacitive"), kind("ideal"), kind("capacitive")]);
  expect(bypass()).toHaveAttribute("aria-pressed", "false");
  for (const name of ["capacitive", "ideal", "capacitive"]) {
    board.status({ parameters: withSensor(name) });
    await board.reply();
    expect(await list()).toHaveValue("capacitive");
  }
  await user.click(bypass());
  expect(board.commands.at(-1)).toEqual(kind("ideal"));
  expect(bypass()).toHaveAttribute("aria-pressed", "true");
});

it("lists the sensors that give a displacement, and a switch for each that needs light", async () => {
  const board = connect(bench);
  const { user } = mount(<SensorChoice />);
  await list();
  const optical = catalog.blocks.filter(
    (b) => b.family === "sense" && !b.axes?.length && !b.outputs.some(({ name }) => name === "displacement"),
  );
  expect(optical.length).toBeGreaterThan(0);
  const offered = Array.from((await list()).options, (option) => option.value);
  for (const { name, title } of optical) {
    expect(offered).not.toContain(name);
    await user.click(screen.getByRole("switch", { name: title }));
    expect(board.commands.at(-1)).toEqual({ set: { [`sensors.${name}.always`]: true } });
  }
  board.status({ parameters: { ...bench.parameters, sensors: { [optical[0].name]: { always: true } } } });
  expect(screen.getByRole("switch", { name: optical[0].title })).toBeChecked();
  await user.click(screen.getByRole("switch", { name: optical[0].title }));
  expect(board.commands.at(-1)).toEqual({ set: { [`sensors.${optical[0].name}.always`]: false } });
});

it("says the known weaknesses of the sensor in use", async () => {
  const weak = catalog.blocks.find((b) => b.family === "sense" && b.weaknesses.length > 0 && b.axes?.length === 0);
  connect({ ...bench, parameters: withSensor(weak?.name as string) });
  mount(<SensorChoice />);
  expect(await screen.findByRole("note")).toHaveTextContent(/^Known weakness/);
});

it("offers a gyroscope its own sensors and no bypass", async () => {
  connect(gyroscope.bench);
  mount(<SensorChoice />);
  expect(Array.from((await list()).options, (option) => option.value)).toContain("pick_off");
  expect(screen.queryByRole("option", { name: "Capacitive" })).not.toBeInTheDocument();
});
