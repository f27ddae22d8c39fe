import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { DeviceSelect } from "./device-select";
import { SensorSelect } from "./header";

const { bench, events } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");
const all = await recordedAnswer("devices");
const IDS = ["ch3", "lcr-350", "table-1-1-350-std", "gyro-c", "double-integrator"];
const devices = { ...all, devices: all.devices.filter(({ id }) => IDS.includes(id)) };
const [fault] = bench.faults;

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/devices", devices);
  server.on("POST", "/benches/:id/variant", { ...bench, id: "next", faults: [] });
  server.on("POST", "/benches", { ...gyroscope.bench, id: "next" });
  server.on("POST", "/benches/next/commands", {});
});

/** The menus of a bench, once the devices have come. */
async function mountMenus(of = bench) {
  const board = connect(of);
  const { user } = mount(
    <>
      <DeviceSelect />
      <SensorSelect />
    </>,
  );
  const menu = screen.getByRole("combobox", { name: "Device" });
  await waitFor(() => expect(menu).not.toHaveValue(""));
  const choose = async (option: RegExp) => {
    await user.click(menu);
    await user.click(await screen.findByRole("option", { name: option }));
  };
  return { board, user, menu, choose };
}

const asked = (path: string) => server.asked("POST", path).map(({ body }) => body);
const question = () => screen.findByRole("dialog", { name: /^The bench begins again with / });
const begin = async (user: Awaited<ReturnType<typeof mountMenus>>["user"]) =>
  user.click(within(await question()).getByRole("button", { name: "Begin again" }));

it("names the device of the bench, and says of each what it is, its resonance and its quality factor", async () => {
  const { user, menu } = await mountMenus();
  expect(menu).toHaveValue("LCR of chapter 3");
  await user.click(menu);
  const option = await screen.findByRole("option", { name: /^LCR-350/ });
  expect(option).toHaveTextContent(/Resonator with a drawing, f₀ 2\.48\skHz, Q 4\.86$/);
  const others = screen.getByText("On a bench of another kind").parentElement as HTMLElement;
  expect(within(others).getByRole("option", { name: /^Gyroscope C/ })).toHaveTextContent(/f₀ 3\.93\skHz/);
  expect(within(others).queryByRole("option", { name: /^LCR/ })).not.toBeInTheDocument();
  expect(screen.getByRole("option", { name: /^Table 1\.1, 350\sµm beams, std/ })).toBeInTheDocument();
  expect(screen.queryByRole("option", { name: /^Double integrator/ })).not.toBeInTheDocument();
});

it("says that the devices are on their way until they have come", async () => {
  server.on("GET", "/devices", () => new Promise(() => undefined));
  connect(bench);
  const { user } = mount(<DeviceSelect />);
  const menu = screen.getByRole("combobox", { name: "Device" });
  expect(menu).toHaveAttribute("placeholder", "Loading");
  await user.click(menu);
  expect(await screen.findByText("The list is on its way.")).toBeVisible();
});

it("asks first, and does nothing on Cancel", async () => {
  const { user, menu, choose } = await mountMenus();
  await choose(/^LCR-350/);
  await user.click(within(await question()).getByRole("button", { name: "Cancel" }));
  await waitFor(() => expect(screen.queryByRole("dialog")).not.toBeInTheDocument());
  expect(asked("/benches/first-look/variant")).toEqual([]);
  expect(menu).toHaveValue("LCR of chapter 3");
});

it("begins again with the device, and injects the faults that act", async () => {
  const { board, user, choose } = await mountMenus();
  await board.events(events);
  await choose(/^LCR-350/);
  await begin(user);
  await waitFor(() => expect(window.location.search).toContain("bench=next"));
  expect(asked("/benches/first-look/variant")).toEqual([{ set: { device: { id: "lcr-350" } }, repeat: false }]);
  const { name, severity, profile, parameters } = fault;
  expect(asked("/benches/next/commands")).toEqual([{ fault: name, severity, profile, parameters }]);
});

it("leaves the faults of the scenario to the scenario", async () => {
  const { board, user, choose } = await mountMenus();
  await board.events(events.map((event) => (event.kind === "inject" ? { ...event, actor: "scenario" } : event)));
  await choose(/^LCR-350/);
  await begin(user);
  await waitFor(() => expect(window.location.search).toContain("bench=next"));
  expect(asked("/benches/next/commands")).toEqual([]);
});

it("begins the first look at a gyroscope, and names in one notice what does not suit it", async () => {
  server.on("POST", "/benches/next/commands", new Refusal(422, "added_mass is for one displacement"));
  const { user, choose } = await mountMenus();
  await choose(/^Gyroscope C/);
  expect(await question()).toHaveTextContent("It needs another plant");
  await begin(user);
  const notice = await screen.findByRole("alert");
  expect(notice).toHaveTextContent("The bench begins with Gyroscope C, dual mass");
  expect(notice).toHaveTextContent("because it does not suit: Open loop, Added mass.");
  expect(asked("/benches")[0]).toMatchObject({
    scenario: "gyro-first-look",
    set: { device: { id: "gyro-c" }, sample_rate_khz: 100 },
  });
});

it("gives a student a new bench of the scenario, with the controller that drives", async () => {
  be("student", { bench: bench.id });
  server.on("POST", "/benches", { ...bench, id: "next" });
  const { user, choose } = await mountMenus();
  await choose(/^LCR-350/);
  expect(await question()).toHaveTextContent("The bench you have now is gone.");
  await begin(user);
  await waitFor(() => expect(window.location.search).toContain("bench=next"));
  expect(asked("/benches")[0]).toMatchObject({
    scenario: "first-look",
    set: { device: { id: "lcr-350" }, "controller.kind": "open_loop" },
  });
});

it("sends the sensor that is chosen", async () => {
  const { board, user } = await mountMenus();
  await user.click(screen.getByRole("combobox", { name: "Sensor" }));
  await user.click(await screen.findByRole("option", { name: /^Capacitive/ }));
  expect(board.commands).toEqual([{ set: { "sensor.kind": "capacitive" } }]);
});

it.each([
  ["in a replay", { replay_of: "recording-1" }, "teacher", "A recording plays. The past cannot be changed."],
  ["for a watcher", {}, "watcher", "You watch this bench and cannot change it."],
  ["while a fault is hidden", { blind: { id: "q" } }, "teacher", "A fault is hidden on this bench. Answer first."],
] as const)("says why neither device nor sensor can be changed %s", async (_, changes, role, why) => {
  be(role);
  await mountMenus({ ...bench, ...changes } as never);
  for (const name of ["Device", "Sensor"]) {
    expect(screen.getByRole("combobox", { name })).toBeDisabled();
    expect(screen.getByRole("combobox", { name })).toHaveAttribute("title", why);
  }
});
