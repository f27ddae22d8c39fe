import { act, screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { openPlace, useView } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { Designer } from "./designer";

const { evaluation, bode, spread, gyroscope } = await recordedAnswer("design");
const devices = await recordedAnswer("devices");
const { bench } = await recordedBench("first-look");
const REFUSED = "nothing is left of the beams";

/** The device of a request as the designer draws it. */
interface Drawn {
  device: { id: string; geometry?: Record<string, number>; drawn_gyroscope?: Record<string, number> };
}

beforeEach(() => {
  connect(bench);
  useView.setState({ page: "designer" });
  server.on("GET", "/devices", devices);
  server.on("POST", "/devices/evaluate", ({ body }: { body: Drawn }) => {
    if ((body.device.geometry?.beam_bias_um ?? 0) > 0.9) return new Refusal(422, REFUSED, { hint: "Draw them wider." });
    return body.device.id.startsWith("gyro") ? gyroscope : evaluation;
  });
  server.on("POST", "/devices/bode", bode);
  server.on("POST", "/devices/spread", spread);
  server.on("POST", "/benches", { ...bench, id: "designed" });
});

async function mountDesigner() {
  const shown = mount(<Designer />);
  await screen.findByRole("region", { name: "Figures" });
  const set = async (name: string | RegExp, value: string, which = 0) => {
    const field = screen.getAllByRole("textbox", { name })[which];
    await shown.user.clear(field);
    await shown.user.type(field, `${value}{Enter}`);
  };
  return { ...shown, set, use: () => screen.getByRole("button", { name: "Use on the bench" }) };
}

const designs = () => server.asked("POST", "/devices/evaluate").map(({ body }) => (body as Drawn).device);

it("shows figures with units, drawing, response and sensitivity of a device", async () => {
  await mountDesigner();
  const figures = within(screen.getByRole("region", { name: "Figures" }));
  expect(figures.getByText(/^2\.484\skHz$/)).toBeVisible();
  expect(figures.getAllByText("as in the catalogue").length).toBeGreaterThan(3);
  expect(figures.getByRole("button", { name: "Resonance: equation 1.3.5, erratum" })).toBeVisible();
  expect(screen.getByRole("img", { name: /from above, to scale/ })).toBeVisible();
  expect(screen.getByRole("img", { name: /^Bode diagram/ })).toBeVisible();
  const row = screen.getByRole("row", { name: /^Beams 0\.2 µm narrower/ });
  expect(
    within(row)
      .getAllByRole("cell")
      .map((cell) => cell.textContent),
  ).toEqual(["−0.4", "−34.4", "−0.7", "0", "−18.8", "−18.6"]);
});

it("opens at the device that the address names, and says so when there is none", async () => {
  const [, other] = devices.devices;
  openPlace("designer", other.id);
  const { user } = await mountDesigner();
  expect(screen.getByRole("combobox", { name: "Device" })).toHaveValue(other.id);
  await user.selectOptions(screen.getByRole("combobox", { name: "Device" }), "lcr-350");
  expect(window.location.pathname).toBe("/design/lcr-350");
  act(() => openPlace("designer", "none"));
  expect(screen.getByText("The catalogue has no device none.")).toBeVisible();
});

it("asks for the response around the resonance", async () => {
  await mountDesigner();
  const f0 = evaluation.metrics.f0_hz;
  expect(server.asked("POST", "/devices/bode")[0].body).toMatchObject({ start_hz: f0 / 10, stop_hz: f0 * 10 });
});

it("works a turned value out at once, and says how far a figure has gone from the catalogue", async () => {
  const { user, set } = await mountDesigner();
  const half = evaluation.figures.map((figure) =>
    figure.name === "f0_hz" ? { ...figure, value: 2 * figure.value } : figure,
  );
  server.on("POST", "/devices/evaluate", { ...evaluation, figures: half });
  await set("Beam length, µm", "175");
  expect(await screen.findByText(/^\+100\.0\s%$/)).toBeVisible();
  expect(designs().at(-1)).toEqual({ id: "lcr-350", geometry: { beam_length_um: 175 } });
  await user.click(screen.getByRole("button", { name: /^Beam length: back to 350/ }));
  await waitFor(() => expect(designs().at(-1)).toEqual({ id: "lcr-350" }));
});

it("sends the air of the design", async () => {
  const { set } = await mountDesigner();
  await set(/^Temperature/, "80");
  await waitFor(() =>
    expect(
      Object.values((server.asked("POST", "/devices/evaluate").at(-1)?.body as { environment: object }).environment),
    ).toEqual([80]),
  );
});

it("does not put a refused design on a bench, and says why, until it is mended", async () => {
  const { set, use } = await mountDesigner();
  expect(use()).toBeEnabled();
  await set("Etch bias per edge, µm", "0.95");
  expect(await screen.findByRole("alert")).toHaveTextContent(`${REFUSED}. Draw them wider.`);
  expect(use()).toBeDisabled();
  expect(screen.getByText(/^2\.484\skHz$/)).toBeVisible(); // the last good picture stays
  await set("Etch bias per edge, µm", "0.2");
  await waitFor(() => expect(screen.queryByRole("alert")).not.toBeInTheDocument());
  expect(use()).toBeEnabled();
});

it("says at its field that a value is beyond its limits, and asks for nothing", async () => {
  const { set } = await mountDesigner();
  const before = designs().length;
  await set("Beam length, µm", "-3");
  const field = screen.getByRole("textbox", { name: "Beam length, µm" });
  expect(field).toBeInvalid();
  expect(within(field.parentElement as HTMLElement).getByRole("alert")).toHaveTextContent(/^at least /);
  expect(designs()).toHaveLength(before);
});

it("puts the design on a bench of its own, driven below its resonance", async () => {
  const { user, set, use } = await mountDesigner();
  await set("Beam length, µm", "175");
  await user.click(use());
  await waitFor(() => expect(window.location.search).toContain("bench=designed"));
  expect(useView.getState().page).toBe("bench");
  expect(server.asked("POST", "/benches")[0].body).toMatchObject({
    scenario: "first-look",
    paused: false,
    set: {
      title: `Designed: ${evaluation.title}`,
      device: { id: "lcr-350", geometry: { beam_length_um: 175 } },
      "reference.frequency_hz": 2000,
    },
  });
});

it("says why no bench was made of a design", async () => {
  server.on("POST", "/benches", new Refusal(409, "There is no free bench."));
  const { user, use } = await mountDesigner();
  await user.click(use());
  expect(await screen.findByText("There is no free bench.")).toBeVisible();
  expect(useView.getState().page).toBe("designer");
});

it("draws devices from the process by their numbers, and goes back to the drawing", async () => {
  const { user } = await mountDesigner();
  await user.click(screen.getByRole("button", { name: "Draw one from the process" }));
  expect(
    await screen.findByText(/^device 1 of the process; 98 % of them have f₀ from 1\.94\skHz to 3\.08\skHz$/),
  ).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Draw another" }));
  expect(await screen.findByText(/^device 2 of the process/)).toBeVisible();
  expect(server.asked("POST", "/devices/spread").map(({ body }) => (body as { seed: number }).seed)).toEqual([1, 2]);
  await waitFor(() => expect(designs().at(-1)?.geometry).toEqual(spread.geometry));
  await user.click(screen.getByRole("button", { name: "Back to the drawing" }));
  expect(screen.queryByText(/of the process;/)).not.toBeInTheDocument();
  await waitFor(() => expect(designs().at(-1)).toEqual({ id: "lcr-350" }));
});

it("shows the axes of a gyroscope, which no process draws, and puts it on a bench with its rate", async () => {
  const { user, use, set } = await mountDesigner();
  await user.selectOptions(screen.getByRole("combobox", { name: "Device" }), "gyro-lcr-350");
  expect(await screen.findByText(/^145\.0\sHz$/)).toBeVisible();
  expect(screen.queryByRole("region", { name: "Frequency response" })).not.toBeInTheDocument();
  expect(screen.getByRole("button", { name: "Draw one from the process" })).toBeDisabled();
  await set("Beam length along y, µm", "330");
  await user.click(use());
  await waitFor(() => expect(server.asked("POST", "/benches")).toHaveLength(1));
  expect(server.asked("POST", "/benches")[0].body).toMatchObject({
    scenario: {
      device: { id: "gyro-lcr-350", drawn_gyroscope: { sense_beam_length_um: 330 } },
      rate: { kind: "constant", deg_per_s: 100 },
      controller: { kind: "force_to_rebalance" },
    },
  });
});

it("asks for the field beyond the fingers of a comb, in the words of the catalogue's choices", async () => {
  const { user } = await mountDesigner();
  const field = screen.getByRole("combobox", { name: "Field beyond the fingers" });
  expect(within(field).getAllByRole("option")).toHaveLength(1 + devices.fringing.choices.length);
  await user.selectOptions(field, "Over a grounded plane");
  await waitFor(() => expect(designs().at(-1)).toEqual({ id: "lcr-350", fringing: "grounded_plane" }));
  await user.selectOptions(field, "None: the force of plates");
  await waitFor(() => expect(designs().at(-1)).toEqual({ id: "lcr-350" }));
  await user.selectOptions(screen.getByRole("combobox", { name: "Device" }), "fabricated-1"); // its force is given
  expect(screen.queryByRole("combobox", { name: "Field beyond the fingers" })).not.toBeInTheDocument();
});

it("gives a gyroscope combs and plates by a switch, turns them, and puts them on a bench that is driven by volts", async () => {
  const combs = { "gyro.force_x_nn_per_v2": 1, "gyro.force_y_nn_per_v2": 1 };
  const { user, use, set } = await mountDesigner();
  await user.selectOptions(screen.getByRole("combobox", { name: "Device" }), "gyro-c");
  expect(screen.queryByRole("textbox", { name: "Gap, as etched, µm" })).not.toBeInTheDocument();
  for (const name of ["Combs along x", "Combs along y", "Tuning electrode"])
    await user.click(screen.getByRole("switch", { name }));
  server.on("POST", "/devices/evaluate", { ...gyroscope, metrics: { ...gyroscope.metrics, ...combs } });
  await set("Gap, as etched, µm", "2", 2);
  await set("Fingers per side", "0", 1);
  expect(screen.getAllByRole("textbox", { name: "Fingers per side" })[1]).toBeInvalid(); // below the catalogue's minimum
  const comb = { bias_v: 10, fingers: 100, thickness_um: 60, gap_um: 3 };
  const tuning = { plates: 20, length_um: 400, thickness_um: 60, gap_um: 2 };
  await waitFor(() =>
    expect(designs().at(-1)).toEqual({ id: "gyro-c", electrodes: { drive: comb, sense: comb, tuning } }),
  );
  await user.click(use());
  await waitFor(() => expect(server.asked("POST", "/benches")).toHaveLength(1));
  expect(server.asked("POST", "/benches")[0].body).toMatchObject({
    scenario: {
      device: { electrodes: { drive: comb, sense: comb, tuning } },
      drive: { by: "volts" },
      plant: { model: "tuned_gyroscope" },
    },
  });
  await user.click(screen.getByRole("switch", { name: "Combs along y" }));
  await waitFor(() => expect(designs().at(-1)).toEqual({ id: "gyro-c", electrodes: { drive: comb, tuning } }));
});

it("has no button to use a design for a watcher", async () => {
  be("watcher");
  mount(<Designer />);
  await screen.findByRole("region", { name: "Figures" });
  expect(screen.queryByRole("button", { name: "Use on the bench" })).not.toBeInTheDocument();
});
