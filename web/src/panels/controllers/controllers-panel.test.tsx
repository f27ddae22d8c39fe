import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useView } from "../../bench/view-store";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { ControllersPanel } from "./controllers-panel";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");

beforeEach(() => server.on("GET", "/catalog", catalog));

async function mountPanel(of = bench) {
  const board = connect(of);
  const { user } = mount(<ControllersPanel />);
  await waitFor(() => expect(radios()).not.toEqual([]));
  return { board, user };
}
/** By value: their names are long formulas. */
const radios = () => [...document.querySelectorAll<HTMLInputElement>("input[type=radio]")];
const radio = (name: string) => radios().find(({ value }) => value === name) as HTMLElement;
const group = (name: string) => within(screen.getByRole("group", { name }));

it("lists the controllers of the bench, and sends the one that is chosen", async () => {
  const { board, user } = await mountPanel();
  expect(
    radios()
      .map(({ value }) => value)
      .sort(),
  ).toEqual([...bench.controllers].sort());
  expect(screen.getByRole("radiogroup", { name: "Controller" })).toBeVisible();
  expect(radio("open_loop")).toBeChecked();
  await user.click(radio("mrac"));
  expect(board.commands).toEqual([{ switch: "mrac", cold: false }]);
  expect(radio("open_loop")).toBeChecked();
  board.status({ controller: "mrac", slots: { "": "mrac" } });
  expect(radio("mrac")).toBeChecked();
});

it("shows the words of a refusal, and sends nothing for a watcher", async () => {
  const { board, user } = await mountPanel();
  await user.click(radio("mrac"));
  await board.refuse("The board has tripped.");
  expect(screen.getByRole("alert")).toHaveTextContent("The board has tripped.");
  be("watcher");
  await user.click(radio("pid"));
  expect(board.commands).toHaveLength(1);
});

it("shows what each controller says now, with its unit", async () => {
  const { board } = await mountPanel();
  board.frame({ "mrac.voltage": () => 4.5, "pid.voltage": () => -0.25 }, { head: 400 });
  await drawOnce();
  expect(radio("mrac").closest("[data-active]")).toHaveTextContent(/4\.50?\sV$/);
  expect(radio("pid").closest("[data-active]")).toHaveTextContent(/−250\smV$/);
});

it.each(["lqg", "adrc", "h_infinity", "sliding_observer"])("offers %s with its voltage of now", async (name) => {
  const { board, user } = await mountPanel();
  board.frame({ [`${name}.voltage`]: () => 4.5 }, { head: 400 });
  await drawOnce();
  expect(radio(name).closest("[data-active]")).toHaveTextContent(/4\.50?\sV$/);
  await user.click(radio(name));
  expect(board.commands).toEqual([{ switch: name, cold: false }]);
});

it("shows the parameters of the controller that drives on its card", async () => {
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Parameters" }));
  expect(useView.getState().card).toBe("controllers.open_loop");
});

it("has the reference with its kind and its numbers", async () => {
  const { board, user } = await mountPanel();
  const form = group("Reference");
  await user.selectOptions(form.getByRole("combobox", { name: "Kind of reference" }), "chirp");
  await user.clear(form.getByRole("textbox", { name: "Amplitude, V" }));
  await user.type(form.getByRole("textbox", { name: "Amplitude, V" }), "3{Enter}");
  expect(board.commands).toEqual([{ set: { "reference.kind": "chirp" } }, { set: { "reference.amplitude_v": 3 } }]);
});

it("has a group for each slot of a gyroscope", async () => {
  const { board, user } = await mountPanel(gyroscope.bench);
  const [drive, sense] = ["Drive controller", "Sense controller"].map((name) => screen.getByRole("group", { name }));
  const values = (slot: HTMLElement) => radios().flatMap((one) => (slot.contains(one) ? one.value : []));
  expect(values(drive)).toEqual(["forced_drive", "waveform_drive", "drive_loop", "drive_tracking"]);
  expect(values(sense)).toContain("force_to_rebalance");
  await user.click(radio("force_to_rebalance"));
  expect(board.commands).toEqual([{ switch: "force_to_rebalance", cold: false }]);
  board.status({ slots: { drive: "drive_loop", sense: "force_to_rebalance" } });
  expect(radio("force_to_rebalance")).toBeChecked();
  expect(radio("drive_loop")).toBeChecked();
});

it("says which controller makes a slot wait", async () => {
  const { board } = await mountPanel(gyroscope.bench);
  board.status({ slots: { drive: "drive_loop", sense: "whole_angle" } });
  expect(screen.getByText(/^Waits: Whole-angle read-out drives this axis as well/)).toBeVisible();
  board.status({ slots: { drive: "drive_loop", sense: "force_to_rebalance" } });
  expect(screen.queryByText(/^Waits/)).not.toBeInTheDocument();
});

it("has a waveform only while the controller that drives reads it", async () => {
  const { board } = await mountPanel(gyroscope.bench);
  expect(screen.getByRole("combobox", { name: "Kind of angular rate" })).toHaveValue("profile");
  expect(screen.queryByRole("combobox", { name: "Kind of waveform" })).not.toBeInTheDocument();
  board.status({ slots: { drive: "waveform_drive", sense: "adaptive_rate" } });
  expect(screen.getByRole("combobox", { name: "Kind of waveform" })).toHaveValue("constant");
  expect(screen.queryByText("Duty")).not.toBeInTheDocument();
  board.status({ parameters: { ...gyroscope.bench.parameters, waveform: { kind: "square" } } });
  expect(screen.getByText("Duty")).toBeVisible();
});

it("shows what the supervisor has concluded, its last act and why", async () => {
  const { board, user } = await mountPanel({ ...bench, supervisor: null });
  expect(screen.queryByRole("group", { name: "Supervisor" })).not.toBeInTheDocument();
  const now = { kind: "switching", diagnoser: "kalman", verdict: "healthy", acting: "", held_ms: 2.5, dead_ms: 0.4 };
  board.status({ supervisor: { ...now, acts: 0, last_act: null } });
  const panel = group("Supervisor");
  expect(panel.getByText("kalman has named healthy for 2.5 ms.")).toBeVisible();
  expect(panel.getByText("Nothing counts for another 400 µs.")).toBeVisible();
  expect(panel.getByRole("status")).toHaveTextContent("It has not acted.");
  const last_act = { tick: 400, text: "switches to PID", reason: "kalman has named mass +5 % for 1 ms, weight 0.998" };
  const acted = { ...now, verdict: "none fits", acting: "m+5", dead_ms: 0, acts: 2, last_act };
  board.status({ supervisor: acted });
  expect(
    panel.getByText(/^kalman has named no hypothesis that fits for 2\.5.ms\. It acted on mass \+5.% last\.$/),
  ).toBeVisible();
  expect(panel.queryByText(/Nothing counts/)).not.toBeInTheDocument();
  expect(panel.getByRole("status")).toHaveTextContent(
    /^Last act, at .*: it switches to PID, because kalman has named mass \+5 % for 1 ms, weight 0\.998\. 2 acts so far\.$/,
  );
  expect(screen.getAllByRole("group")[0]).toHaveAccessibleName("Supervisor"); // before the long list of laws
  await user.click(screen.getByRole("button", { name: "Parameters of the supervisor" }));
  expect(useView.getState().card).toBe("supervisor");
});

it("says beside an estimate that is not trusted that it is not", async () => {
  const { board } = await mountPanel(gyroscope.bench);
  board.frame({ "adaptive_rate.rate": () => 12, "adaptive_rate.trusted": () => 0 }, { head: 400 });
  await drawOnce();
  expect(radio("adaptive_rate").closest("[data-active]")).toHaveTextContent(/deg\/snot trusted$/);
});
