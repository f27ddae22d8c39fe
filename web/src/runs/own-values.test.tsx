import { screen, waitFor } from "@testing-library/react";
import { expect, it } from "vitest";
import { Refusal, server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { mount } from "../testing/render";
import { OwnValues, ownValues } from "./own-values";

const run = await recordedAnswer("run");

const USUAL = `title = "Seven steps"
seed = 1
samples = 9000

[controller]
kind = "open_loop"

[sensor]
kind = "ideal"
noise_um = 0.05

[[events]]
at_sample = 2000
fault = "added_mass"
severity = 0.05

[events.profile]
kind = "ramp"
duration_ms = 10

[[events]]
at_sample = 3000
severity = 0.5

[[expect]]
metric = "control.rms_error_um"
max = 8
`;
const said = (own: string) => ownValues(USUAL, own).replaceAll(/\s/g, " ");

it.each([
  ["severity = 0.5\n", "severity = 0.8\n", "severity 0.5 → 0.8"],
  ["noise_um = 0.05", "noise_um = 0.15", "noise 0.05 → 0.15 µm"],
  ["duration_ms = 10", "duration_ms = 20", "duration 10 → 20 ms"],
  ["noise_um = 0.05", "noise_um = 0.15\n\n[sensors.ideal]\nnoise_um = 0.05", "noise 0.05 → 0.15 µm"],
  ['kind = "open_loop"', 'kind = "pid"', "controller kind open loop → pid"],
  ["[sensor]", "[sensor]\ndelay_ticks = 3", "delay ticks 3"],
  ["severity = 0.5\n", "severity = 0.5\n\n[[events]]\nat_sample = 4000\n", "at sample 4000"],
])("says the value that a run changes: %s", (usual, own, words) => {
  expect(said(USUAL.replace(usual, own))).toBe(words);
});

it.each([
  ["seed = 1", "seed = 7"],
  ["max = 8", "max = 9"],
  ['[sensor]\nkind = "ideal"\n', '[sensor]\nkind = "ideal"\n\n[sensors.ideal]\n'],
  ["severity = 0.5\n", "severity = 0.50\n"],
  ["Seven steps", "Mine"],
])("says nothing of seeds, claims, titles and other ways to write a value: %s", (usual, own) => {
  expect(said(USUAL.replace(usual, own))).toBe("");
});

it("lists several values in the order of the scenario", () => {
  expect(said(USUAL.replace("0.05\n", "0.1\n").replace("severity = 0.05", "severity = 0.3"))).toBe(
    "noise 0.05 → 0.1 µm, severity 0.05 → 0.3",
  );
});

it("asks for the values of a run once it is in sight, and shows them", async () => {
  server.on("GET", "/scenarios/first-look", { toml: USUAL });
  server.on("GET", "/runs/run-1/scenario", USUAL.replace("severity = 0.5\n", "severity = 0.8\n"));
  mount(<OwnValues run={run} />);
  expect(await screen.findByText("severity 0.5 → 0.8")).toBeVisible();
});

it("shows nothing for a run of a scenario that the library does not have", async () => {
  server.on("GET", "/scenarios/first-look", new Refusal(404, "no such scenario"));
  server.on("GET", "/runs/run-1/scenario", USUAL);
  mount(<OwnValues run={run} />);
  await waitFor(() => expect(server.asked("GET", "/scenarios/first-look")).toHaveLength(1));
  expect(screen.queryByText(/severity/)).not.toBeInTheDocument();
});
