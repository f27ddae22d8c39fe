import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { be, mount } from "../../testing/render";
import { HypothesesPanel } from "./hypotheses-panel";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const aliases = await recordedAnswer("aliases");
const ALIASES = "/benches/first-look/diagnosers/kalman/aliases";
const VARIANT = "/benches/first-look/variant";
const { hypotheses } = (bench.parameters.diagnosers as { kalman: { hypotheses: { name: string }[] } }).kalman;

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("POST", "/benches/:id/diagnosers/:name/aliases", aliases);
  server.on("POST", "/benches/:id/variant", { ...bench, id: "next" });
});

function mountPanel() {
  connect(bench);
  const { user } = mount(<HypothesesPanel />);
  const enter = async (label: string, value: string) => {
    await user.clear(field(label));
    await user.type(field(label), `${value}{Enter}`);
  };
  return { user, enter };
}
const field = (label: string) => screen.getByLabelText(label);
const add = () => screen.getByRole("button", { name: "Hypothesis" });
const names = () => screen.getAllByLabelText(/^Name of hypothesis/).map((one) => (one as HTMLInputElement).value);
const sentHypotheses = () =>
  (server.asked("POST", ALIASES).at(-1)?.body as { hypotheses: { name: string }[] }).hypotheses;

it("lists the hypotheses of the bank in percent, and asks which coincide", async () => {
  mountPanel();
  expect(names()).toEqual(hypotheses.map(({ name }) => name));
  expect(field("mass of m+5, %")).toHaveValue("5");
  expect(field("damping of b+30, %")).toHaveValue("30");
  expect(await screen.findByText(/At this one tone 1 % of mass moves like −0\.65\s% of stiffness/)).toBeVisible();
  expect(sentHypotheses()[1]).toEqual({ name: "m+5", mass: 1.05, stiffness: 1, damping: 1, gain: 1 });
});

it("draws the motion of every hypothesis, and the closest pairs in numbers", async () => {
  mountPanel();
  const plot = await screen.findByRole("img", { name: /in the complex plane$/ });
  await drawOnce();
  for (const { name } of hypotheses) expect(penOf(plot).words).toContain(name);
  const [{ first, second }] = aliases.map.pairs;
  expect(
    screen.getByRole("row", { name: new RegExp(`${first} and ${second}`.replaceAll("+", "\\+")) }),
  ).toHaveTextContent(/[nµ]m/);
});

it("marks a pair that coincides as aliases", async () => {
  const [closest, ...others] = aliases.map.pairs;
  const pairs = [{ ...closest, first: "m+5", second: "soft", coincident: true }, ...others];
  server.on("POST", "/benches/:id/diagnosers/:name/aliases", { ...aliases, map: { ...aliases.map, pairs } });
  mountPanel();
  expect(await screen.findByRole("row", { name: /m\+5 and soft .*aliases$/ })).toBeVisible();
});

it("adds the hypothesis that is not there yet, and renames it by what it changes", async () => {
  const { user, enter } = mountPanel();
  await user.click(add());
  expect(names().at(-1)).toBe("m+15");
  await enter("stiffness of m+15, %", "-3.25");
  expect(names().at(-1)).toBe("m+15k-3,25");
  await enter("mass of m+15k-3,25, %", "0");
  expect(names().at(-1)).toBe("k-3,25");
  await waitFor(() => expect(sentHypotheses().at(-1)).toMatchObject({ name: "k-3,25", mass: 1, stiffness: 0.9675 }));
});

it("says that a name appears twice, and begins no bench with it", async () => {
  const { user } = mountPanel();
  await user.click(add());
  await user.clear(field("Name of hypothesis 7"));
  await user.type(field("Name of hypothesis 7"), "m+5");
  expect(screen.getByRole("alert")).toHaveTextContent("m+5 appears twice.");
  expect(screen.getByRole("button", { name: "Restart with this list" })).toBeDisabled();
});

it("begins again with the new list as a bench of its own", async () => {
  const { user } = mountPanel();
  const begin = screen.getByRole("button", { name: "Restart with this list" });
  expect(begin).toBeDisabled();
  await user.click(screen.getByRole("button", { name: "Leave out b+30" }));
  await user.click(begin);
  await waitFor(() => expect(server.asked("POST", VARIANT)).toHaveLength(1));
  const [{ body }] = server.asked("POST", VARIANT);
  expect(body).toEqual({ set: { "diagnosers.kalman.hypotheses": hypotheses.slice(0, -1) }, repeat: false });
  await waitFor(() => expect(window.location.search).toContain("bench=next"));
});

it("says why a bench cannot begin", async () => {
  server.on("POST", "/benches/:id/variant", new Refusal(409, "There is no room for another bench."));
  const { user } = mountPanel();
  await user.click(add());
  await user.click(screen.getByRole("button", { name: "Restart with this list" }));
  expect(await screen.findByText("There is no room for another bench.")).toBeVisible();
});

it("goes back to the list of the bench", async () => {
  const { user } = mountPanel();
  await user.click(screen.getByRole("button", { name: "Leave out m+5" }));
  expect(names()).not.toContain("m+5");
  await user.click(screen.getByRole("button", { name: "As it was" }));
  expect(names()).toEqual(hypotheses.map(({ name }) => name));
});

it("races another method on the same list", async () => {
  const { user } = mountPanel();
  const race = screen.getByRole("combobox", { name: "Let another method race on the same list" });
  await screen.findByRole("option", { name: catalog.blocks.find((b) => b.name === "imm")?.title });
  await user.selectOptions(race, "imm");
  await waitFor(() => expect(server.asked("POST", VARIANT)).toHaveLength(1));
  expect(server.asked("POST", VARIANT)[0].body).toMatchObject({
    set: { "diagnosers.imm": { kind: "imm", hypotheses } },
  });
});

it("shows a refusal of the aliases in words", async () => {
  server.on(
    "POST",
    "/benches/:id/diagnosers/:name/aliases",
    new Refusal(422, "The drive has no tone", { hint: "Use a sine." }),
  );
  mountPanel();
  expect(await screen.findByRole("alert")).toHaveTextContent("The drive has no tone. Use a sine.");
});

it("begins nothing for a student", () => {
  be("student");
  mountPanel();
  expect(screen.queryByRole("button", { name: /^Begin again/ })).not.toBeInTheDocument();
  expect(screen.queryByRole("combobox", { name: /^Let another/ })).not.toBeInTheDocument();
});
