import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { Refusal, server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { mount } from "../testing/render";
import { StartForm } from "./start-form";

const { scenarios } = await recordedAnswer("scenarios");
const library = scenarios.filter(({ id }) => ["first-look", "ch5-seven-step"].includes(id));
const DOCUMENT = { id: "ch5-seven-step", title: "Seven", sensor: { kind: "ideal", noise_um: 0.4 }, samples: 3800 };
const RUN = { scenario: "ch5-seven-step", label: "", all: false, set: {}, seeds: "1:1" };

beforeEach(() => {
  server.on("GET", "/scenarios", { scenarios: library });
  server.on("GET", "/scenarios/:id", { document: DOCUMENT });
  server.on("POST", "/runs", { id: "run-1" });
  server.on("POST", "/sweeps", { id: "sweep-1" });
});

function mountForm() {
  const onStarted = vi.fn();
  const shown = mount(<StartForm onStarted={onStarted} />);
  const form = within(screen.getByRole("form", { name: "Start" }));
  const campaign = () => shown.user.click(form.getByRole("radio", { name: "Campaign" }));
  const type = async (name: string | RegExp, value: string) => {
    const field = form.getByLabelText<HTMLInputElement>(name, { selector: "input:not([type=hidden])" });
    const { length } = field.value;
    await shown.user.type(field, value, { initialSelectionStart: 0, initialSelectionEnd: length });
  };
  return { ...shown, form, campaign, type, onStarted };
}

it("starts one run of a scenario with its name, another value, seeds and all signals", async () => {
  const { user, form, type, onStarted } = mountForm();
  await type("Name", "Quieter");
  await user.click(form.getByRole("button", { name: "Change a value" }));
  await user.type(form.getByRole("combobox", { name: "With other values 1: path" }), "sensor.noise_u");
  await user.click(await screen.findByRole("option", { name: /^sensor\.noise_um/ }));
  await type("sensor.noise_um: value", "0.06");
  await type("First seed", "5");
  await type("Seeds", "3");
  await user.click(form.getByRole("checkbox", { name: "Keep all signals" }));
  await user.click(form.getByRole("button", { name: /^Run 3\sseeds$/ }));
  expect(server.asked("POST", "/runs").map(({ body }) => body)).toEqual([
    { ...RUN, label: "Quieter", all: true, set: { "sensor.noise_um": 0.06 }, seeds: "5:7" },
  ]);
  expect(onStarted).toHaveBeenCalledWith({ kind: "run", id: "run-1" });
});

it("leaves a field of a number empty while it is, and takes one for it", async () => {
  const { user, form } = mountForm();
  const seeds = form.getByRole("textbox", { name: "Seeds" });
  await user.clear(seeds);
  expect(seeds).toHaveValue("");
  await user.click(form.getByRole("button", { name: "Run" }));
  expect(server.asked("POST", "/runs")[0].body).toEqual(RUN);
  await user.type(seeds, "4");
  expect(seeds).toHaveValue("4");
});

it("names the field that the server refuses, and takes the words away at the next start", async () => {
  server.on("POST", "/runs", new Refusal(422, "must be at least 0", { field: "sensor.noise_um", hint: "Give more." }));
  const { user, form, onStarted } = mountForm();
  await user.click(form.getByRole("button", { name: "Run" }));
  expect(await form.findByRole("alert")).toHaveTextContent("sensor.noise_um: must be at least 0. Give more.");
  expect(onStarted).not.toHaveBeenCalled();
  server.on("POST", "/runs", { id: "run-1" });
  await user.click(form.getByRole("button", { name: "Run" }));
  expect(form.queryByRole("alert")).not.toBeInTheDocument();
  expect(onStarted).toHaveBeenCalledTimes(1);
});

it("does not say a field twice", async () => {
  server.on("POST", "/runs", new Refusal(422, "sensor.noise_um must be positive", { field: "sensor.noise_um" }));
  const { user, form } = mountForm();
  await user.click(form.getByRole("button", { name: "Run" }));
  expect(await form.findByRole("alert")).toHaveTextContent(/^sensor\.noise_um must be positive\.\s*$/);
});

it("starts a campaign over a grid, and counts its runs", async () => {
  const { user, form, campaign, type, onStarted } = mountForm();
  await campaign();
  await user.type(form.getByRole("combobox", { name: "Grid over 1: path" }), "sensor.noise_um");
  await type("sensor.noise_um: value", "0.05, 0.2");
  await type("Seeds", "3");
  expect(form.getByText(/^2\spoints with 3\sseeds each\./)).toBeVisible();
  await user.click(form.getByRole("button", { name: /^Start 6\sruns$/ }));
  expect(server.asked("POST", "/sweeps").map(({ body }) => body)).toEqual([
    {
      sweep: {
        schema: 1,
        id: "ch5-seven-step",
        scenario: "ch5-seven-step",
        set: {},
        seeds: "1:3",
        grid: { "sensor.noise_um": [0.05, 0.2] },
      },
      label: "",
    },
  ]);
  expect(onStarted).toHaveBeenCalledWith({ kind: "campaign", id: "sweep-1" });
});

it("starts a campaign over a hypercube, its last range included, with devices of the process", async () => {
  const { user, form, campaign, type } = mountForm();
  await campaign();
  await user.click(form.getByRole("radio", { name: "Hypercube" }));
  await user.click(form.getByRole("button", { name: "Another range" }));
  await user.type(form.getByRole("combobox", { name: "Spread evenly over 1: path" }), "a.b");
  await user.type(form.getByRole("combobox", { name: "Spread evenly over 2: path" }), "c.d");
  await type("a.b: from", "1");
  await type("a.b: to", "2");
  await type("c.d: from", "0.1");
  await type("c.d: to", "10");
  await user.click(form.getByRole("checkbox", { name: "c.d: logarithmic" }));
  await type("Points", "4");
  await type("Seed of the points", "9");
  await type("Random devices", "2");
  await user.click(form.getByRole("button", { name: /^Start 8\sruns$/ }));
  expect(server.asked("POST", "/sweeps")[0].body).toMatchObject({
    sweep: {
      latin_hypercube: {
        points: 4,
        seed: 9,
        ranges: { "a.b": { min: 1, max: 2, scale: "linear" }, "c.d": { min: 0.1, max: 10, scale: "log" } },
      },
      process_spread: { devices: 2 },
    },
  });
});

it("starts a campaign over the rows of a CSV file, and counts them", async () => {
  const { user, form, campaign } = mountForm();
  await campaign();
  await user.click(form.getByRole("radio", { name: "Table" }));
  const text = "sensor.noise_um,controller.kind\n0.05,mrac\n0.2,pid\n";
  const chooser = document.querySelector<HTMLInputElement>("input[type=file]");
  if (!chooser) throw new Error("there is no chooser of files");
  await user.upload(chooser, new File([text], "design.csv", { type: "text/csv" }));
  await vi.waitFor(() => expect(form.getByRole("textbox", { name: "Rows" })).toHaveValue(text));
  await user.click(form.getByRole("button", { name: /^Start 2\sruns$/ }));
  const { sweep } = server.asked("POST", "/sweeps")[0].body as { sweep: object };
  expect(sweep).toMatchObject({ points: { csv: text }, seeds: "1:1" });
  expect(sweep).not.toHaveProperty("grid");
});

it("removes a row that is not wanted", async () => {
  const { user, form } = mountForm();
  for (const _ of [1, 2]) await user.click(form.getByRole("button", { name: "Change a value" }));
  await user.type(form.getByRole("combobox", { name: "With other values 1: path" }), "a");
  await user.type(form.getByRole("combobox", { name: "With other values 2: path" }), "b");
  await user.click(form.getByRole("button", { name: "Remove a" }));
  expect(form.getByRole("combobox", { name: "With other values 1: path" })).toHaveValue("b");
  expect(form.queryByRole("combobox", { name: "With other values 2: path" })).not.toBeInTheDocument();
});

it("refuses a value in a grid by its field", async () => {
  server.on("POST", "/sweeps", new Refusal(422, "-1 is below 0", { field: "grid.sensor.noise_um" }));
  const { user, form, campaign } = mountForm();
  await campaign();
  await user.click(form.getByRole("button", { name: /^Start 1\srun$/ }));
  expect(await form.findByRole("alert")).toHaveTextContent("grid.sensor.noise_um: -1 is below 0.");
});
