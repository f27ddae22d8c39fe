import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount, words } from "../../testing/render";
import { FaultsPanel } from "./faults-panel";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");

beforeEach(() => server.on("GET", "/catalog", catalog));

/** The panel of a bench, with the form of a fault open. */
async function openForm(title: string, of = { ...bench, faults: [] as typeof bench.faults }) {
  const board = connect(of);
  const { user } = mount(<FaultsPanel />);
  await user.click(await screen.findByRole("button", { name: title }));
  const form = within(screen.getByRole("button", { name: title, expanded: true }).closest("li") as HTMLElement);
  const type = async (label: string, value: string) => {
    await user.clear(form.getByLabelText(label));
    await user.type(form.getByLabelText(label), value);
  };
  const choose = (option: string) => user.click(form.getByRole("radio", { name: option }));
  return { board, user, form, type, choose };
}

it("lists the faults under their headings, and says that the device is healthy", async () => {
  connect({ ...bench, faults: [] });
  mount(<FaultsPanel />);
  const mass = await screen.findByRole("button", { name: words("Inject +5 %: Added mass") });
  expect(mass.closest("section")).toHaveAccessibleName("The usual");
  expect(screen.getByText("The device is healthy")).toBeVisible();
  expect(screen.queryByRole("button", { name: "Heal all" })).not.toBeInTheDocument();
  expect(screen.queryByText("Quadrature")).not.toBeInTheDocument(); // a fault of gyroscopes
});

it("injects the suggested severity with one press", async () => {
  const board = connect({ ...bench, faults: [] });
  const { user } = mount(<FaultsPanel />);
  await user.click(await screen.findByRole("button", { name: words("Inject +5 %: Added mass") }));
  expect(board.commands).toEqual([{ fault: "added_mass", severity: 0.05, profile: { kind: "step" } }]);
});

it("shows a fault that acts, heals it, and heals all", async () => {
  const board = connect(bench);
  const { user } = mount(<FaultsPanel />);
  expect(await screen.findByText(/^1\sactive fault$/)).toBeVisible();
  const row = screen.getByRole("button", { name: "Added mass" }).closest("li") as HTMLElement;
  expect(row).toHaveTextContent("+5 % since 18.000 ms");
  await user.click(within(row).getByRole("button", { name: "Heal" }));
  await user.click(screen.getByRole("button", { name: "Heal all" }));
  expect(board.commands).toEqual([{ heal: ["added_mass"] }, { heal: "all" }]);
  board.status({ faults: [] });
  expect(screen.getByText("The device is healthy")).toBeVisible();
});

it("injects an exact severity as a ramp", async () => {
  const { board, user, form, type, choose } = await openForm("Added mass");
  await type("Severity of Added mass, exact", "7.5");
  await choose("ramp");
  await type("Over", "12");
  await user.click(form.getByRole("button", { name: words("Inject +7.5 %") }));
  expect(board.commands).toEqual([
    { fault: "added_mass", severity: 0.075, profile: { kind: "ramp", duration_ms: 12 } },
  ]);
});

it("lets a fault wait for a moment of device time", async () => {
  const { board, user, form, type, choose } = await openForm("Added mass");
  await choose("at a time");
  await type("At device time", "30");
  await user.click(form.getByRole("button", { name: words("Let it wait for its moment +5 %") }));
  expect(board.commands).toEqual([{ fault: "added_mass", severity: 0.05, profile: { kind: "step" }, at_ms: 30 }]);
});

it("lets a fault wait for a condition", async () => {
  const { board, user, form, type, choose } = await openForm("Added mass");
  await choose("on a condition");
  await type("Level", "2");
  await user.click(form.getByRole("button", { name: words("Let it wait for its moment +5 %") }));
  expect(board.commands).toEqual([
    { fault: "added_mass", severity: 0.05, profile: { kind: "step" }, when: `${bench.signals[0].name} > 2` },
  ]);
});

it("sends nothing while a severity is beyond its limits, and says so", async () => {
  const { board, user, form, type } = await openForm("Added mass");
  await type("Severity of Added mass, exact", "-99");
  await user.click(form.getByRole("button", { name: /^Inject .*99\s%$/ }));
  expect(board.commands).toEqual([]);
  expect(form.getByLabelText("Severity of Added mass, exact")).toBeInvalid();
});

it("asks again for a catalogue that did not come", async () => {
  server.on("GET", "/catalog", new Refusal(503, "The service is busy."));
  connect(bench);
  const { user } = mount(<FaultsPanel />);
  expect(await screen.findByText("The server did not send the catalogue")).toBeVisible();
  server.on("GET", "/catalog", catalog);
  await user.click(screen.getByRole("button", { name: "Ask again" }));
  expect(await screen.findByText(/^1\sactive fault$/)).toBeVisible();
  expect(server.asked("GET", "/catalog")).toHaveLength(2);
});
