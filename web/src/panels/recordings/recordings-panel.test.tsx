import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { RecordingsPanel } from "./recordings-panel";

const { recordings, compared } = await recordedAnswer("recordings");
const { bench } = await recordedBench("first-look");
const RECORD = `/benches/${bench.id}/recordings`;

beforeEach(() => {
  vi.spyOn(window, "confirm").mockReturnValue(true);
  server.on("GET", "/recordings", { recordings });
  server.on("POST", RECORD, recordings[0]);
  connect(bench);
});

async function mountPanel() {
  const shown = mount(<RecordingsPanel />);
  await screen.findAllByRole("listitem");
  return shown;
}

it("lists each recording with its length, its beginning and its files", async () => {
  await mountPanel();
  const rows = screen.getAllByRole("listitem");
  expect(rows.map((row) => row.querySelector("b")?.textContent)).toEqual(["second", "first"]);
  expect(rows[1]).toHaveTextContent(
    new RegExp(`1\\.500\\sms from 19\\.000\\sms · ${recordings[1].signals.length}\\ssignals`),
  );
  expect(within(rows[1]).getByRole("link", { name: "CSV" })).toHaveAttribute(
    "href",
    "./api/v1/recordings/recording-first/trace?format=csv",
  );
});

it("records some of the past for a time, in ticks", async () => {
  const { user } = await mountPanel();
  await user.type(screen.getByLabelText("Name"), "step");
  await user.tripleClick(screen.getByLabelText("Of the past"));
  await user.keyboard("2");
  await user.type(screen.getByLabelText("Length"), "3");
  await user.click(screen.getByRole("button", { name: "Record" }));
  expect(server.asked("POST", RECORD)[0].body).toEqual({
    name: "step",
    past_ticks: 200,
    ticks: 300,
    when: null,
    layout: null,
  });
});

it("stops what is recorded, and says why it did not begin", async () => {
  server.on("POST", `${RECORD}/:id/stop`, recordings[0]);
  server.on("POST", RECORD, new Refusal(507, "There is no room."));
  const board = connect({ ...bench, recording: ["r1"] } as typeof bench);
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Stop recording" }));
  expect(server.asked("POST", `${RECORD}/r1/stop`)).toHaveLength(1);
  board.status({ recording: [] });
  await user.click(screen.getByRole("button", { name: "Record" }));
  expect(await screen.findByText("There is no room.")).toBeVisible();
});

it("replays one on a bench of its own, and deletes one when that is confirmed", async () => {
  server.on("POST", "/recordings/:id/replay", { ...bench, id: "replay" });
  server.on("DELETE", "/recordings/:id");
  const { user } = await mountPanel();
  vi.mocked(window.confirm).mockReturnValueOnce(false);
  await user.click(screen.getByRole("button", { name: "Delete first" }));
  expect(server.asked("DELETE", "/recordings/recording-first")).toEqual([]);
  await user.click(screen.getByRole("button", { name: "Delete first" }));
  expect(server.asked("DELETE", "/recordings/recording-first")).toHaveLength(1);
  await user.click(screen.getByRole("button", { name: "Replay second" }));
  expect(server.asked("POST", "/recordings/recording-second/replay")[0].body).toEqual({ speed: 1, paused: false });
  expect(window.location.search).toContain("bench=replay");
});

it("compares two, failures first, with differences in their units", async () => {
  server.on("POST", "/recordings/recording-first/compare", compared);
  const { user } = await mountPanel();
  await user.click(screen.getByRole("button", { name: "Compare first with another" }));
  const view = within(screen.getByRole("region", { name: "Comparison" }));
  await user.click(view.getByRole("radio", { name: "first on first" }));
  await user.click(view.getByRole("button", { name: "Compare" }));
  expect(server.asked("POST", "/recordings/recording-first/compare")[0].body).toEqual({
    other: "recording-second",
    absolute: 0,
    relative: 0.01,
    tolerances: {},
    align: "start",
  });
  const failed = compared.signals.filter(({ ok }) => !ok).length;
  expect(await view.findByRole("status")).toHaveTextContent(
    `Fail: ${compared.signals.length - failed} of ${compared.signals.length} signals`,
  );
  const row = view.getByRole("row", { name: /^plant\.displacement/ });
  expect(row).toHaveTextContent(/51\.53\snm/);
  expect(row).toHaveTextContent(/fail$/);
});

it("has neither a form nor a deletion for a watcher", async () => {
  be("watcher");
  await mountPanel();
  for (const name of [/^Record/, /^Delete/, /^Replay/, /^Compare/])
    expect(screen.queryByRole("button", { name })).not.toBeInTheDocument();
});
