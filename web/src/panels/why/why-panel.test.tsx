import { act, screen, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { useView } from "../../bench/view-store";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { hover } from "../../ui/hover";
import { WhyPanel } from "./why-panel";

const { bench } = await recordedBench("first-look");
const account = await recordedAnswer("explanation");
const turn = await recordedAnswer("turn");
const EXPLAIN = "/benches/first-look/diagnosers/kalman/explain";

beforeEach(() => {
  server.on("GET", "/benches/:id/diagnosers/:name/explain", ({ query }: { query: { tick: string } }) => ({
    ...account,
    tick: Number(query.tick),
  }));
  server.on("GET", "/benches/:id/diagnosers/:name/turn", turn);
});

/** The panel with the last sample chosen. */
function mountWhy(tick = account.tick) {
  const board = connect(bench);
  useView.setState({ sample: { diagnoser: "kalman", tick } });
  return { board, ...mount(<WhyPanel />) };
}

const row = (name: string) => screen.findByRole("row", { name: new RegExp(`^${name.replace("+", "\\+")} `) });
const sample = () => screen.getByRole("textbox", { name: "Sample" });
const asked = () => server.asked("GET", EXPLAIN).map(({ query }) => query.tick);

it("says how to choose a sample while none is chosen, and explains the latest one on a click", async () => {
  const board = connect(bench);
  useView.setState({ sample: undefined });
  const { user } = mount(<WhyPanel />);
  expect(screen.getByText("No sample chosen")).toBeVisible();
  expect(board.commands).toEqual([]);
  await user.click(screen.getByRole("button", { name: "Explain the latest sample" }));
  expect(useView.getState().sample?.diagnoser).toBe("kalman");
});

it("shows every hypothesis with its numbers and units, and the winner in a sentence", async () => {
  mountWhy();
  const best = await row("m+5");
  expect(screen.getAllByRole("row")).toHaveLength(1 + account.models.length);
  expect(best).toHaveTextContent("99.48 %");
  expect(best).toHaveTextContent("1.2 σ");
  expect(best).toHaveTextContent(/0\.2808\s1\/ms/);
  expect(best).toHaveTextContent(/−60\.1\snm/);
  expect(best).toHaveTextContent(/98\.99\s%$/);
  expect(screen.getByText(/^Mass \+5\s% wins: it misses by 1\.2 σ, healthy by 1\.5 σ\.$/)).toBeVisible();
  expect(screen.getByText(/^0\.019\s990\ss$/)).toBeVisible();
});

it("shows the four equations of the hypothesis that is chosen", async () => {
  const { user } = mountWhy();
  await row("m+5");
  expect(screen.getAllByRole("listitem")).toHaveLength(4);
  expect(screen.getByRole("heading", { name: /^m\+5 at this sample/ })).toBeVisible();
  await user.click(screen.getByRole("button", { name: "k+10" }));
  expect(screen.getByRole("heading", { name: /^k\+10 at this sample, in µm and ms$/ })).toBeVisible();
  expect(screen.getByRole("button", { name: "k+10" })).toHaveAttribute("aria-pressed", "true");
});

it("asks for the sample after, the sample before and the sample that is typed", async () => {
  const { user } = mountWhy();
  await row("m+5");
  await user.click(screen.getByRole("button", { name: "Sample after" }));
  expect(sample()).toHaveValue("2000");
  await user.click(screen.getByRole("button", { name: "Sample before" }));
  await user.click(screen.getByRole("button", { name: "Sample before" }));
  expect(sample()).toHaveValue("1998");
  await user.clear(sample());
  await user.type(sample(), "77{Enter}");
  expect(asked()).toEqual(["1999", "2000", "1999", "1998", "77"]);
});

it("says in words that a sample is not kept, and offers the latest one", async () => {
  const message = "tick: is not kept; the history has samples 0 to 1999";
  server.on("GET", EXPLAIN, new Refusal(422, message, { field: "tick", hint: "Choose a newer one." }));
  mountWhy(999_999_999);
  expect(await screen.findByText("Sample 999999999 is not kept; the history has samples 0 to 1999.")).toBeVisible();
  expect(screen.getByText("Choose a newer one.")).toBeVisible();
  expect(screen.getByRole("button", { name: "Explain the latest sample" })).toBeEnabled();
  expect(screen.queryByRole("table")).not.toBeInTheDocument();
});

it("says where the verdict last turned, and goes there", async () => {
  const { user } = mountWhy();
  expect(
    await screen.findByText(`The verdict last turned at sample ${turn.tick}, from healthy.`, { exact: false }),
  ).toBeVisible();
  await user.click(screen.getByRole("button", { name: "The sample where it turned" }));
  expect(sample()).toHaveValue(String(turn.tick));
  expect(await screen.findByText(/The verdict turned at this sample/)).toBeVisible();
  expect(screen.getByRole("button", { name: "The sample where it turned" })).toBeDisabled();
});

it("says that the verdict has not turned before any fault", async () => {
  server.on("GET", "/benches/:id/diagnosers/:name/turn", { tick: null, before: "", since: 0 });
  mountWhy(1);
  expect(await screen.findByText(/The verdict has not turned since sample 0, the first one kept\./)).toBeVisible();
  expect(screen.getByRole("button", { name: "The sample where it turned" })).toBeDisabled();
});

it("follows a pointer that rests, and goes back to the sample that was chosen", async () => {
  vi.useFakeTimers();
  mountWhy();
  await row("m+5");
  act(() => hover.set(500.7));
  act(() => hover.set(640.2));
  expect(sample()).toHaveValue("1999");
  await act(() => vi.advanceTimersByTimeAsync(150));
  expect(sample()).toHaveValue("640");
  expect(asked()).toEqual(["1999", "640"]);
  act(() => hover.set(undefined));
  expect(sample()).toHaveValue("1999");
});

it("asks another diagnoser of the bench about the same sample", async () => {
  const { kalman } = bench.diagnosers;
  connect({ ...bench, diagnosers: { kalman, second: kalman } });
  useView.setState({ sample: { diagnoser: "kalman", tick: 1999 } });
  const { user } = mount(<WhyPanel />);
  await row("m+5");
  await user.selectOptions(screen.getByRole("combobox", { name: "Diagnoser" }), "second");
  await row("m+5");
  expect(server.asked("GET", "/benches/first-look/diagnosers/second/explain")[0].query).toEqual({ tick: "1999" });
});

it("shows a bank of two displacements each residual and its deviation along its axis", async () => {
  const models = account.models.map((model) => ({
    ...model,
    residual_um: [0.002, -0.5],
    covariance_um2: [
      [0.04, 0],
      [0, 4],
    ],
    gain: [
      [0.1, 0],
      [0, 0.25],
      [1, 0],
      [0, 2],
    ],
  }));
  server.on("GET", EXPLAIN, {
    ...account,
    models,
    residuals: ["residual_x", "residual_y"],
    gain_units: ["1", "1", "1/ms", "1/ms"],
    weighed: "the winner raised by the least evidence",
  });
  mountWhy();
  const healthy = await row("healthy");
  expect(screen.getByRole("columnheader", { name: "Residual along x, y" })).toBeVisible();
  expect(healthy).toHaveTextContent(/2\.00\snm−500\snm/);
  expect(healthy).toHaveTextContent(/200\snm2\.00\sµm/);
  expect(screen.getByText("Weighed by the winner raised by the least evidence")).toBeVisible();
});

it("says that a bench has no diagnoser that weighs hypotheses", () => {
  connect({ ...bench, diagnosers: {} });
  mount(<WhyPanel />);
  expect(screen.getByText("This bench has no diagnoser that weighs hypotheses.")).toBeVisible();
  expect(within(document.body).queryByRole("button", { name: /Explain/ })).not.toBeInTheDocument();
});
