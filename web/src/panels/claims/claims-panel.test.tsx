import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import type { ThresholdRun } from "../../api/types";
import { usePrinted } from "../../bench/printed";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { ClaimsPanel } from "./claims-panel";

const { bench } = await recordedBench("seven-steps");
const claims = await recordedAnswer("claims");
const [correct] = claims.claims;
const judged = {
  ...correct,
  state: "holds",
  as_expected: true,
  verdict: "confirmed",
  knobs: [
    {
      path: "sensor.noise_um",
      label: "True noise",
      unit: "um",
      value: 0.05,
      low: 0.001,
      high: 1,
      is_log: true,
      is_live: true,
      is_fitted: false,
      fault: "",
    },
  ],
} as unknown as typeof correct;
const started = {
  id: "threshold-1",
  state: "running",
  progress: 0.25,
  error: null,
  found: null,
} as unknown as ThresholdRun;

beforeEach(() => server.on("GET", "/benches/:id/claims", claims));

async function mountPanel(of = bench) {
  const board = connect(of);
  const { user } = mount(<ClaimsPanel />);
  await screen.findByRole("region", { name: "Claims" });
  return { board, user };
}
const card = () => screen.getAllByRole("listitem")[0];
const number = (name: string) => within(card()).getByText(name, { selector: "dt" }).nextElementSibling;

it("shows each claim with what is printed, expected and measured", async () => {
  await mountPanel();
  expect(screen.getAllByRole("listitem")).toHaveLength(claims.claims.length);
  expect(screen.getByText(claims.claim)).toBeVisible();
  expect(card()).toHaveAccessibleName(/: not yet$/);
  expect(number("printed")).toHaveTextContent(correct.published);
  expect(number("expected")).toHaveTextContent("at least 0.9800");
  expect(number("measured")).toHaveTextContent("0.9830");
  expect(card()).toHaveTextContent("Why: with psi = HP-H' + R, a probability floor and h = 20 µs");
  expect(screen.getByText(/^Measured over 40\.?0*\sms of 180\.?0*\sms; judged at the end\.$/)).toBeVisible();
});

it("says whether a claim holds as printed once the run is over", async () => {
  server.on("GET", "/benches/:id/claims", {
    ...claims,
    tick: 9000,
    is_over: true,
    claims: [judged, { ...judged, metric: "other", state: "fails" }],
  });
  await mountPanel();
  const [first, second] = screen.getAllByRole("listitem");
  expect(first).toHaveAccessibleName(/: holds as printed$/);
  expect(second).toHaveAccessibleName(/: does not hold as printed$/);
  expect(screen.getByText(/^Measured over the whole run, 180\.?0*\sms\.$/)).toBeVisible();
});

it("takes the printed marks out of the scopes, and remembers it", async () => {
  const { user } = await mountPanel();
  await user.click(screen.getByRole("checkbox", { name: "Printed marks on the scopes" }));
  expect(usePrinted.getState().isShown).toBe(false);
  expect(localStorage.getItem("combbench.printed")).toBe("off");
});

it("asks nothing while a fault is hidden", () => {
  connect({ ...bench, blind: { id: "b" } as never });
  mount(<ClaimsPanel />);
  expect(server.requests).toEqual([]);
  expect(screen.queryByRole("listitem")).not.toBeInTheDocument();
});

it("says why the claims cannot be measured, and that an experiment makes none", async () => {
  server.on("GET", "/benches/:id/claims", new Refusal(409, "The run has been changed."));
  connect(bench);
  const { unmount } = mount(<ClaimsPanel />);
  expect(await screen.findByText("The run has been changed.")).toBeVisible();
  unmount();
  server.on("GET", "/benches/:id/claims", { ...claims, claims: [] });
  connect({ ...bench, id: "other" });
  mount(<ClaimsPanel />);
  expect(await screen.findByText("This experiment makes no claim")).toBeVisible();
});

it("finds where a claim holds, and changes the bench with the slider", async () => {
  server.on("GET", "/benches/:id/claims", { ...claims, claims: [judged] });
  server.on("POST", "/thresholds", started);
  server.on("GET", "/thresholds/:id", started);
  server.on("DELETE", "/thresholds/:id");
  const { board, user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Where does it hold?" }));
  await user.click(screen.getByRole("button", { name: "Find where it holds" }));
  expect(await screen.findByRole("button", { name: /^Cancel, 25\s% done$/ })).toBeVisible();
  await user.click(screen.getByRole("button", { name: /^Cancel/ }));
  expect(server.asked("DELETE", "/thresholds/threshold-1")).toHaveLength(1);
  expect(server.asked("POST", "/thresholds")[0].body).toEqual({
    bench: bench.id,
    metric: judged.metric,
    path: "sensor.noise_um",
    low: 0.001,
    high: 1,
    scale: "log",
  });
  const field = screen.getByRole("textbox", { name: "True noise, µm" });
  await user.clear(field);
  await user.type(field, "0.2{Enter}");
  expect(board.commands).toEqual([{ set: { "sensor.noise_um": 0.2 } }]);
  await user.click(screen.getByRole("button", { name: "Begin the bench again with it" }));
  expect(board.commands[1]).toEqual({ kind: "reset", values: { "sensor.noise_um": 0.2 } });
});

it("says where a claim holds, draws it, and says why a search failed", async () => {
  const found = {
    metric: judged.metric,
    path: "sensor.noise_um",
    low: 0.001,
    high: 1,
    scale: "log",
    tried: [
      { value: 0.05, measured: 0.983, holds: true },
      { value: 0.6, measured: 0.7, holds: false },
    ],
    turns: [],
    words: "holds below 0.31",
  };
  server.on("GET", "/benches/:id/claims", { ...claims, claims: [judged] });
  server.on("POST", "/thresholds", started);
  server.on("GET", "/thresholds/:id", { ...started, state: "done", found });
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Where does it hold?" }));
  await user.click(screen.getByRole("button", { name: "Find where it holds" }));
  expect(await screen.findByText("It holds below 0.31, in µm.")).toBeVisible();
  expect(screen.getByRole("img", { name: /over True noise: holds below 0\.31$/ })).toBeVisible();
  expect(screen.getByText(/measured at 50\snm: holds$/)).toBeVisible();
  server.on("GET", "/thresholds/:id", { ...started, state: "failed", error: { message: "Too far." } });
  server.on("POST", "/thresholds", { ...started, id: "threshold-2" });
  await user.click(screen.getByRole("button", { name: "Find where it holds" }));
  expect(await screen.findByText("Too far.")).toBeVisible();
});

it("offers the search to who teaches only", async () => {
  be("student");
  server.on("GET", "/benches/:id/claims", { ...claims, claims: [judged] });
  await mountPanel();
  expect(screen.queryByRole("button", { name: "Where does it hold?" })).not.toBeInTheDocument();
});
