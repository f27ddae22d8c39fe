import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { openPlace } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { mount } from "../testing/render";
import { EquationIndex } from "./equation-index";
import { Excitation } from "./excitation";
import { Instability } from "./instability";
import { PositiveReal } from "./positive-real";
import { Theory } from "./theory";

const { positiveReal, persistency, map } = await recordedAnswer("theory");
const catalog = await recordedAnswer("catalog");

beforeEach(() => {
  server.on("POST", "/theory/positive-real", positiveReal);
  server.on("POST", "/theory/persistency", persistency);
  server.on("POST", "/theory/instability-map", map);
  server.on("GET", "/catalog", { blocks: catalog.blocks.filter(({ family }) => family === "control").slice(0, 4) });
});

it("judges the transfer function that is typed", async () => {
  const { user } = mount(<PositiveReal />);
  expect(await screen.findByText("Strictly positive real")).toBeVisible();
  expect(server.asked("POST", "/theory/positive-real")[0].body).toEqual({ numerator: [1, 1], denominator: [1, 5, 6] });
  server.on("POST", "/theory/positive-real", { ...positiveReal, strictly_positive_real: false });
  await user.click(screen.getByRole("button", { name: "1/s" }));
  expect(await screen.findByText("Positive real, but not strictly")).toBeVisible();
  expect(server.asked("POST", "/theory/positive-real").at(-1)?.body).toEqual({ numerator: [1], denominator: [1, 0] });
  const not = { ...positiveReal, strictly_positive_real: false, positive_real: false, reasons: ["it falls below"] };
  server.on("POST", "/theory/positive-real", not);
  await user.click(screen.getByRole("button", { name: "1/(s^2+0.2s+1)" }));
  expect(await screen.findByText("Not positive real")).toBeVisible();
  expect(screen.getByText("it falls below")).toBeVisible();
});

it("says at its field what is wrong with a transfer function, and asks nothing", async () => {
  const { user } = mount(<PositiveReal />);
  await screen.findByText("Strictly positive real");
  await user.type(screen.getByLabelText("G(s)"), "*(");
  expect(screen.getByLabelText("G(s)")).toBeInvalid();
  expect(server.asked("POST", "/theory/positive-real")).toHaveLength(1);
});

it("weighs the tones of an input, the last one added too", async () => {
  const { user } = mount(<Excitation />);
  expect(await screen.findByText(/^Not persistently exciting/)).toBeVisible();
  expect(screen.getByText(/^Condition infinite/)).toBeVisible();
  server.on("POST", "/theory/persistency", { ...persistency, exciting: true, condition: 12 });
  await user.click(screen.getByRole("button", { name: "Four tones" }));
  expect(await screen.findByText("Persistently exciting")).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Add a tone" }));
  await waitFor(() =>
    expect((server.asked("POST", "/theory/persistency").at(-1)?.body as { tones: object[] }).tones.at(-1)).toEqual({
      amplitude: 10,
      frequency: 1.9,
    }),
  );
  expect(screen.getAllByRole("button", { name: /^Remove tone/ })).toHaveLength(5);
});

it("draws where a rule is unstable, and says how much", async () => {
  const { user } = mount(<Instability />);
  const share = map.growth.flat().filter((g) => g > 1e-6).length / 30;
  expect(
    await screen.findByRole("img", { name: /^MIT rule: growth over frequency and gain; \d+\s% unstable$/ }),
  ).toHaveAccessibleName(new RegExp(`; ${Math.round(100 * share)}\\s% unstable$`));
  server.on("POST", "/theory/instability-map", { ...map, critical_gain_constant: null });
  await user.selectOptions(screen.getByLabelText("Rule"), "Dressler");
  expect(await screen.findByText(/Under a constant input the rule is stable at every gain/)).toBeVisible();
  expect(server.asked("POST", "/theory/instability-map").at(-1)?.body).toMatchObject({ rule: "dressler" });
});

it("shows the words of a refusal", async () => {
  server.on("POST", "/theory/instability-map", new Refusal(422, "The map is too large."));
  mount(<Instability />);
  expect(await screen.findByRole("alert")).toHaveTextContent("The map is too large.");
});

it("counts the equations, finds those with several words, and those with errata", async () => {
  const { user } = mount(<EquationIndex />);
  const status = screen.getByRole("status");
  await waitFor(() => expect(status).toHaveTextContent(/^[1-9]\d*\sequations, \d+ of them with errata$/));
  const all = Number.parseInt(status.textContent ?? "", 10);
  await waitFor(() => expect(screen.getAllByRole("listitem")).toHaveLength(all));
  await user.click(screen.getByRole("switch", { name: "Errata only" }));
  await waitFor(() => expect(status).toHaveTextContent(/with errata$/));
  expect(within(status).queryByText(/of them/)).not.toBeInTheDocument();
  await user.type(screen.getByLabelText("Search equations"), "no such thing");
  expect(await screen.findByText("No equation has all these words.")).toBeVisible();
  expect(window.location.pathname).toBe("/theory/no%20such%20thing");
});

it("names a family above its equations and a block above its own, and neither again", async () => {
  const blocks = catalog.blocks.filter(({ family, name }) => family === "reference" || name === "mrac");
  server.on("GET", "/catalog", { blocks });
  mount(<EquationIndex />);
  const of = async (family: string) => {
    const section = within(await screen.findByRole("region", { name: family }));
    return section.getAllByRole("listitem").map((row) => row.firstElementChild?.textContent);
  };
  for (const text of await of("reference")) expect(text).not.toMatch(/reference/);
  const [first, ...others] = await of("control");
  expect(first).toMatch(/^Direct MRAC/);
  expect(others.length).toBeGreaterThan(0);
  for (const text of others) expect(text).not.toMatch(/MRAC/);
});

it("opens at the equations that the address names", async () => {
  const [block] = catalog.blocks.filter(({ family }) => family === "control");
  openPlace("theory", `${block.title} ${block.equations[0].label}`);
  mount(<EquationIndex />);
  expect(screen.getByLabelText("Search equations")).toHaveValue(`${block.title} ${block.equations[0].label}`);
  const rows = await screen.findAllByRole("listitem");
  expect(rows.length).toBeLessThan(4);
  for (const row of rows) expect(row).toHaveTextContent(block.title);
});

it("has the equations in front, as its links of old, and each calculator in a tab that the address names", async () => {
  openPlace("theory");
  const { user } = mount(<Theory />);
  expect(screen.getByRole("heading", { name: "Equations" })).toBeVisible();
  for (const [tab, region, address] of [
    ["Positive real", "Positive real", "positive-real"],
    ["Excitation", "Persistent excitation", "excitation"],
    ["Stability", "Instability map", "stability"],
  ]) {
    await user.click(screen.getByRole("tab", { name: tab }));
    expect(screen.getByRole("region", { name: region })).toBeVisible();
    expect(screen.queryByRole("heading", { name: "Equations" })).not.toBeInTheDocument();
    expect(window.location.pathname).toBe(`/theory/${address}`);
  }
});
