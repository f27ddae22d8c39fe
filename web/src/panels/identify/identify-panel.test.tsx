import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { IdentifyPanel } from "./identify-panel";

const { bench } = await recordedBench("first-look");
const identification = await recordedAnswer("identification");
const PATH = "/benches/first-look/identification";

beforeEach(() => server.on("POST", "/benches/:id/identification", identification));

function mountPanel() {
  connect(bench);
  const { user } = mount(<IdentifyPanel />);
  const enter = async (label: string, value: string) => {
    await user.clear(screen.getByRole("textbox", { name: label }));
    await user.type(screen.getByRole("textbox", { name: label }), `${value}{Enter}`);
  };
  return { user, enter };
}

it("says that nothing is measured yet, and asks for a sweep as it is set", async () => {
  const { user, enter } = mountPanel();
  expect(screen.getByText("Not measured yet")).toBeVisible();
  await enter("Amplitude, V", "3");
  await enter("Tones of each pass", "11");
  await user.click(screen.getByRole("button", { name: "Sweep the device" }));
  await screen.findByRole("table");
  expect(server.asked("POST", PATH).map(({ body }) => body)).toEqual([
    { amplitude_v: 3, points: 11, cycles: 40, settle: 12, start_hz: null, stop_hz: null },
  ]);
});

it("shows each figure with its unit, its standard error and how far it is from the nominal one", async () => {
  const { found, nominal } = identification;
  const damping_ns_m = 0.8 * nominal.damping_ns_m;
  const figures = { ...found, f0_hz: 2480.5, f0_error_hz: 0.25, damping_ns_m, damping_error_ns_m: 1e-12 };
  server.on("POST", "/benches/:id/identification", { ...identification, found: figures });
  const { user } = mountPanel();
  await user.click(screen.getByRole("button", { name: "Sweep the device" }));
  const cells = async (name: string) =>
    within(await screen.findByRole("row", { name: new RegExp(`^${name}`) })).getAllByRole("cell");
  const [measured] = await cells("Resonance f₀");
  expect(measured.textContent).toBe("2.48050\u00a0±\u00a00.00025\u00a0kHz");
  const change = (await cells("Damping β"))[1];
  expect(change).toHaveTextContent("−20.00 %");
  expect(change).toHaveAttribute("data-sure", "true");
  expect(screen.getAllByRole("row")).toHaveLength(7);
  expect(screen.getByText(/^At tick/)).toHaveTextContent(/2.?000/);
});

it("draws the measured tones over the fitted and the nominal response", async () => {
  const { user } = mountPanel();
  await user.click(screen.getByRole("button", { name: "Sweep the device" }));
  expect(await screen.findByText(`${identification.tones.length} tones measured`)).toBeVisible();
  for (const name of ["Fitted", "Nominal"]) expect(screen.getByText(name)).toBeVisible();
});

it("says why a sweep is refused, and can be asked again", async () => {
  server.on("POST", "/benches/:id/identification", new Refusal(422, "The device is unstable.", { hint: "Heal it." }));
  const { user } = mountPanel();
  await user.click(screen.getByRole("button", { name: "Sweep the device" }));
  expect(await screen.findByRole("alert")).toHaveTextContent("The device is unstable.Heal it.");
  server.on("POST", "/benches/:id/identification", identification);
  await user.click(screen.getByRole("button", { name: "Sweep the device" }));
  expect(await screen.findByRole("button", { name: "Sweep again" })).toBeEnabled();
});

it("refuses a number of tones out of its range in words", async () => {
  const { enter } = mountPanel();
  await enter("Tones of each pass", "3");
  expect(screen.getByRole("alert")).toHaveTextContent("at least 4");
});
