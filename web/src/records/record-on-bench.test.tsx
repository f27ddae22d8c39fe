import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { DeviceSelect } from "../app/header/device-select";
import { SensorSelect } from "../app/header/header";
import { hintsOf } from "../app/hints";
import { RecordLine } from "../app/record-line";
import { TimeBar } from "../app/time-bar";
import { ControllersPanel } from "../panels/controllers/controllers-panel";
import { FaultsPanel } from "../panels/faults/faults-panel";
import { LanesHeadline } from "../panels/lanes/lanes-headline";
import { ScoreboardPanel } from "../panels/scoreboard/scoreboard-panel";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { drawOnce } from "../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { mount, words } from "../testing/render";

const { bench, status } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const played = (labels: string[]): typeof bench => ({
  ...bench,
  faults: [],
  record: { key: "ab".repeat(32), samples: 9000, labels },
});

beforeEach(() => server.on("GET", "/catalog", catalog));

it("says how long the record is, and that nothing is scored without labels", async () => {
  const board = connect(played([]));
  const { user } = mount(<RecordLine />);
  expect(screen.getByRole("region", { name: "Record" })).toHaveTextContent(/It has no labels: the truth is not known/);
  await user.click(screen.getByRole("button", { name: "As fast as it goes" }));
  expect(board.commands).toEqual([{ kind: "time_scale", value: null }]);
});

it("says of a live record whether its instrument sends, and why it has ended", () => {
  const instrument = { source: "scope", is_connected: true, is_growing: true, ended: "" } as NonNullable<
    typeof bench.instrument
  >;
  const board = connect({ ...played([]), time_scale: null, instrument });
  mount(<RecordLine />);
  const line = screen.getByRole("region", { name: "Record" });
  expect(line).toHaveTextContent(/^scope, live:it is measured now\. It has no labels/);
  board.status({ instrument: { ...instrument, is_connected: false } });
  expect(line).toHaveTextContent(/the instrument is gone; the bench waits for it\. It has no labels/);
  const ended = "the record of instrument scope ends at sample 2000: the server was stopped";
  board.status({ instrument: { ...instrument, is_connected: false, is_growing: false, ended } });
  expect(line).toHaveTextContent(/The record of instrument scope ends at sample 2000: the server was stopped\./);
});

it("goes forward in the record by the timeline, as far as the record is long", async () => {
  const board = connect({ ...played([]), tick: 8000, first_tick: 0, earliest_tick: 0, state: "paused", origin: null });
  const { user } = mount(<TimeBar />);
  const slider = screen.getByRole("slider", { name: "Moment shown by all panels" });
  expect(slider).toHaveAttribute("aria-valuemax", "9000");
  slider.focus();
  await user.keyboard("{ArrowRight}");
  await drawOnce();
  await waitFor(() => expect(board.commands).toEqual([{ kind: "step", ticks: 1 }]));
});

it("shows nothing on a bench of a simulated plant", () => {
  connect(bench);
  mount(<RecordLine />);
  expect(screen.queryByRole("region", { name: "Record" })).not.toBeInTheDocument();
});

it("names the real device and the measured sensor in the header, and lets nobody change them", async () => {
  server.on("GET", "/devices", { devices: [], geometry: [] });
  connect({ ...played([]), parameters: { ...bench.parameters, sensor: { kind: "recorded" } } });
  mount(
    <>
      <DeviceSelect />
      <SensorSelect />
    </>,
  );
  expect(await screen.findByDisplayValue("Real device")).toBeDisabled();
  expect(screen.getByDisplayValue("As measured")).toBeDisabled();
  expect(hintsOf(played([]))).toBeUndefined();
});

it("says that faults of a measured device cannot be injected", () => {
  connect(played([]));
  mount(<FaultsPanel />);
  expect(screen.getByText(/no fault of it can be injected now/)).toBeVisible();
  expect(screen.queryByRole("button", { name: "Heal all" })).not.toBeInTheDocument();
});

it("says that a controller cannot drive a record", async () => {
  connect(played([]));
  mount(<ControllersPanel />);
  expect(await screen.findByText(/^A controller cannot drive a record/)).toBeVisible();
});

it("has no score without labels", () => {
  connect(played([]));
  mount(<ScoreboardPanel />);
  expect(screen.getByText(/^The record has no labels, so the truth is not known/)).toBeVisible();
});

it("has the score by the labels of a record", () => {
  const board = connect(played(["healthy"]));
  mount(<ScoreboardPanel />);
  board.status({ scores: status.scores });
  expect(screen.getAllByRole("row", { name: /^kalman/ })[0]).toHaveTextContent("97.75");
});

it("says in the lanes that the truth is not in the record", () => {
  connect(played([]));
  mount(<LanesHeadline id="kalman" names={["healthy"]} switches={[]} />);
  expect(screen.getByText("not in the record")).toBeVisible();
});

it("keeps the truth of a record with labels", () => {
  const board = connect(played(["healthy"]));
  mount(<LanesHeadline id="kalman" names={bench.diagnosers.kalman.names} switches={[]} />);
  board.status(status);
  expect(screen.queryByText("not in the record")).not.toBeInTheDocument();
  expect(screen.getByText(words("97.8 %"))).toBeVisible();
});
