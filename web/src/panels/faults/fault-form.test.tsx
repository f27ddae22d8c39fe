import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { FaultsPanel } from "./faults-panel";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");

beforeEach(() => server.on("GET", "/catalog", catalog));

/** The panel of a healthy bench, with the form of a fault open. */
async function openForm(title: string, of = { ...bench, faults: [] as typeof bench.faults }) {
  const board = connect(of);
  const { user } = mount(<FaultsPanel />);
  await user.click(await screen.findByText(title));
  const row = screen.getByText(title).closest("li") as HTMLElement;
  const type = async (label: string, value: string) => {
    await user.clear(within(row).getByLabelText(label));
    await user.type(within(row).getByLabelText(label), value);
  };
  const inject = () =>
    user.click(
      within(row)
        .getAllByText(/^(Inject|Let it wait)/)
        .at(-1) as HTMLElement,
    );
  return { board, user, row, type, inject, form: within(row) };
}

it("has its groups in order, the usual first and the surroundings last", async () => {
  connect({ ...bench, faults: [] });
  mount(<FaultsPanel />);
  await screen.findByText("Added mass");
  const groups = screen.getAllByRole("heading", { level: 3 }).map((one) => one.textContent);
  expect(groups[0]).toBe("The usual");
  expect(groups.at(-1)).toBe("Surroundings");
});

it("moves the severity by 1 % with each arrow key, and its field follows", async () => {
  const { board, user, form, inject } = await openForm("Added mass");
  const exact = form.getByLabelText("Severity of Added mass, exact");
  expect(exact).toHaveValue("5 %");
  form.getByRole("slider", { name: "Severity of Added mass" }).focus();
  await user.keyboard("{ArrowRight}");
  expect(exact).toHaveValue("6 %");
  await user.keyboard("{ArrowRight}{ArrowRight}{ArrowLeft}");
  expect(exact).toHaveValue("7 %");
  await inject();
  expect(board.commands).toEqual([{ fault: "added_mass", severity: 0.07, profile: { kind: "step" } }]);
});

it("injects an intermittent fault with its period and its share", async () => {
  const { board, user, form, type, inject } = await openForm("Added mass");
  await user.click(form.getByLabelText("intermittent"));
  await type("Every", "8");
  await type("On for", "25");
  await inject();
  expect(board.commands).toEqual([
    { fault: "added_mass", severity: 0.05, profile: { kind: "intermittent", period_ms: 8, duty: 0.25 } },
  ]);
});

it("sends nothing while a duration is missing, and says so at its field", async () => {
  const { board, user, form, type, inject } = await openForm("Added mass");
  await user.click(form.getByLabelText("ramp"));
  await type("Over", "0");
  await inject();
  expect(board.commands).toEqual([]);
  expect(form.getByLabelText("Over")).toBeInvalid();
});

it("sends a condition below a level", async () => {
  const { board, user, form, type, inject } = await openForm("Added mass");
  await user.click(form.getByLabelText("on a condition"));
  await user.selectOptions(form.getByLabelText("When"), "drive.voltage");
  await user.selectOptions(form.getByLabelText("is"), "<");
  await type("Level", "-1.5");
  expect(form.getByLabelText("Level")).toHaveValue("-1.5 V");
  await inject();
  expect(board.commands[0]).toMatchObject({ when: "drive.voltage < -1.5" });
});

it("sends the parameters of a fault, in the unit of the catalogue", async () => {
  const fault = catalog.blocks.find((b) => b.name === "sensor_hum");
  const { board, form, type, inject } = await openForm(fault?.title as string);
  const [own] = form.getAllByRole("textbox").filter((one) => one.getAttribute("aria-label")?.includes("Hz"));
  await type(own.getAttribute("aria-label") as string, "60");
  (own as HTMLInputElement).blur();
  await inject();
  expect(board.commands[0]).toMatchObject({ fault: "sensor_hum", parameters: { frequency_hz: 60 } });
});

it("shows the words of a refusal, and leaves the form as it was", async () => {
  const { board, form, inject, type } = await openForm("Added mass");
  await type("Severity of Added mass, exact", "8");
  await inject();
  await board.refuse("The bench replays a recording.", { hint: "Fork it." });
  expect(screen.getByText("The bench replays a recording.")).toBeVisible();
  expect(form.getByLabelText("Severity of Added mass, exact")).toHaveValue("8 %");
  expect(screen.getByText("The device is healthy")).toBeVisible();
});

it("sends nothing for a watcher, and says why", async () => {
  be("watcher");
  const { board, inject } = await openForm("Added mass");
  await inject();
  expect(board.commands).toEqual([]);
  expect(screen.getByText("You watch this bench and cannot change it.")).toBeVisible();
});

it("counts several faults and lists each with its own severity and time", async () => {
  const [mass] = bench.faults;
  const board = connect({
    ...bench,
    faults: [
      mass,
      { ...mass, name: "stiffness", severity: -0.1, since_tick: 1900 },
      { ...mass, name: "damping", severity: 0 },
    ],
  });
  const { user } = mount(<FaultsPanel />);
  expect(await screen.findByText(/^2\sactive faults$/)).toBeVisible();
  const row = (title: string) => screen.getByText(title).closest("li") as HTMLElement;
  const stiffness = catalog.blocks.find((b) => b.family === "faults" && b.name === "stiffness")?.title as string;
  expect(row(stiffness)).toHaveTextContent(/−10\s% since 19\.000\sms/);
  await user.click(within(row(stiffness)).getByText("Heal"));
  expect(board.commands).toEqual([{ heal: ["stiffness"] }]);
});

it("has the faults of a gyroscope and no point adhesion on one", async () => {
  connect(gyroscope.bench);
  mount(<FaultsPanel />);
  expect(await screen.findByText("Added mass")).toBeVisible();
  expect(screen.getByText("Quadrature")).toBeVisible();
  expect(screen.queryByText("Point adhesion")).not.toBeInTheDocument();
});
