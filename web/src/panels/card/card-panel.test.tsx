import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useView } from "../../bench/view-store";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { CardPanel } from "./card-panel";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/units", { units: [], refusal: null });
});

/** The card of a block of the bench. */
async function mountCard(card: string, of = bench) {
  const board = connect(of);
  useView.setState({ card });
  const shown = mount(<CardPanel />);
  await screen.findByRole("heading", { level: 2 });
  const enter = async (label: string, value: string) => {
    await shown.user.clear(screen.getByRole("textbox", { name: label }));
    await shown.user.type(screen.getByRole("textbox", { name: label }), `${value}{Enter}`);
  };
  return { board, ...shown, enter };
}

it("shows title, summary, equations and parameters of a block", async () => {
  await mountCard("controllers.mrac");
  const mrac = catalog.blocks.find((b) => b.family === "control" && b.name === "mrac");
  const card = screen.getByRole("region", { name: `Block: ${mrac?.title}` });
  expect(within(card).getAllByRole("figure")).toHaveLength(mrac?.equations.length as number);
  const shown = mrac?.parameters.filter((p) => p.type !== "list" && p.type !== "table") ?? [];
  for (const { meaning } of shown) expect(within(card).getByText(meaning, { exact: false })).toBeVisible();
});

it("sends a parameter on Enter, and shows the value of the board", async () => {
  const { board, enter } = await mountCard("sensor");
  await enter("Noise, µm", "0.2");
  expect(board.commands).toEqual([{ set: { "sensor.noise_um": 0.2 } }]);
  board.status({ parameters: { ...bench.parameters, sensors: { ideal: { noise_um: 0.2 } } } });
  await board.reply();
  expect(screen.getByRole("textbox", { name: "Noise, µm" })).toHaveValue("0.2");
});

it("refuses a parameter out of its range in words at its field, and sends nothing", async () => {
  const { board, enter } = await mountCard("sensor");
  await enter("Noise, µm", "-1");
  const field = screen.getByRole("textbox", { name: "Noise, µm" });
  expect(field).toBeInvalid();
  expect(field.parentElement).toContainElement(screen.getByRole("alert"));
  expect(screen.getByRole("alert")).toHaveTextContent("at least 0");
  expect(board.commands).toEqual([]);
});

it("shows the words of a refusal of the server", async () => {
  const { board, enter } = await mountCard("sensor");
  await enter("Noise, µm", "0.2");
  await board.refuse("is too large here", { field: "sensor.noise_um", hint: "Choose less." });
  expect(screen.getByRole("alert")).toHaveTextContent("is too large hereField: sensor.noise_um. Choose less.");
});

it("goes back to the default of a parameter", async () => {
  const { board, user } = await mountCard("sensor");
  const noise = catalog.blocks
    .find((b) => b.family === "sense" && b.name === "ideal")
    ?.parameters.find((p) => p.name === "noise_um");
  board.status({ parameters: { ...bench.parameters, sensors: { ideal: { noise_um: 0.7 } } } });
  await user.click(screen.getByRole("button", { name: "Noise: back to the default" }));
  expect(board.commands).toEqual([{ set: { "sensor.noise_um": noise?.default } }]);
});

it("collects changes, and applies them in one command", async () => {
  const { board, user, enter } = await mountCard("reference");
  await user.click(screen.getByRole("checkbox", { name: /^Collect changes/ }));
  await enter("Amplitude, V", "5");
  await enter("Frequency, Hz", "1500");
  expect(board.commands).toEqual([]);
  await user.click(screen.getByRole("button", { name: "Apply 2 in one tick" }));
  expect(board.commands).toEqual([{ set: { "reference.amplitude_v": 5, "reference.frequency_hz": 1500 } }]);
  await board.refuse("No.");
  expect(screen.getByRole("button", { name: "Apply 2 in one tick" })).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Apply 2 in one tick" }));
  await board.reply();
  expect(screen.queryByRole("button", { name: /^Apply/ })).not.toBeInTheDocument();
});

it("sends another kind of the reference", async () => {
  const { board, user } = await mountCard("reference");
  await user.selectOptions(screen.getByRole("combobox", { name: "Kind of reference" }), "square");
  expect(board.commands).toEqual([{ set: { "reference.kind": "square" } }]);
});

it("shows another block that is chosen from its list", async () => {
  const { user } = await mountCard("sensor");
  await user.selectOptions(screen.getByRole("combobox", { name: "Block" }), "controllers.pid");
  expect(await screen.findByRole("heading", { name: "PID" })).toBeVisible();
  expect(useView.getState().card).toBe("controllers.pid");
});

it("shows the values of now with their units", async () => {
  const { board } = await mountCard("reference");
  board.frame({ "reference.voltage": () => 3.25 }, { head: 400 });
  await drawOnce();
  const row = within(screen.getByRole("region", { name: "Live values" }))
    .getByText("voltage")
    .closest("div");
  expect(row).toHaveTextContent(/3\.25\d*\sV/);
});

it("says the known weaknesses of a block", async () => {
  const weak = catalog.blocks.find((b) => b.family === "diagnose" && b.name === "anchored");
  const diagnosers = { kalman: { kind: "anchored" } };
  await mountCard("diagnosers.kalman", { ...bench, parameters: { ...bench.parameters, diagnosers } });
  expect(screen.getAllByRole("note")).toHaveLength(weak?.weaknesses.length as number);
  for (const note of screen.getAllByRole("note")) expect(note).toHaveTextContent(/^Known weakness/);
});

it("opens what was printed beside the equation that is right", async () => {
  const wrong = catalog.blocks.find((b) => b.family === "control" && b.equations.some(({ printed }) => printed));
  const { user } = await mountCard(`controllers.${wrong?.name}`, { ...bench, controllers: [wrong?.name as string] });
  await user.click(screen.getAllByRole("button", { name: /^Erratum/ })[0]);
  expect(await screen.findByText(/printed/i, { selector: "[role=dialog] *" })).toBeVisible();
});

it("is for a watcher to read only", async () => {
  be("watcher");
  await mountCard("sensor");
  expect(screen.getByText("You watch this bench; its values cannot be changed here.")).toBeVisible();
  expect(screen.getByRole("textbox", { name: "Noise, µm" })).toBeDisabled();
});

it("asks again for a catalogue that did not come", async () => {
  server.on("GET", "/catalog", new Refusal(503, "The service is busy."));
  connect(bench);
  const { user } = mount(<CardPanel />);
  expect(await screen.findByText("The server did not send the catalogue")).toBeVisible();
  server.on("GET", "/catalog", catalog);
  await user.click(screen.getByRole("button", { name: "Ask again" }));
  expect(await screen.findByRole("heading", { level: 2 })).toBeVisible();
});
