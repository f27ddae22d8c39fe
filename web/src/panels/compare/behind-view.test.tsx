import { act, screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import type { Bench } from "../../api/types";
import { useBehind } from "../../bench/behind";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { BehindView } from "./behind-view";

const { bench, events } = await recordedBench("first-look");
const other: Bench = { ...bench, id: "other", name: "Heavier", title: "Other" };
const fast: Bench = { ...bench, id: "fast", name: "Faster", dt_ms: bench.dt_ms / 2, sample_rate_khz: 200 };
const past: Bench = { ...bench, id: "past", name: "Past", origin: { bench: "b", tick: 1, is_past: true } as never };
const recordings = [
  { id: "rec-1", name: "A recording", dt_ms: bench.dt_ms },
  { id: "rec-2", name: "Of another rate", dt_ms: 1 },
];
const runs = [{ id: "run-1", label: "", title: "A run" }];
/** The last fault of the other bench came 200 ticks before the last fault of this bench. */
const earlier = events.map((event) => ({ ...event, tick: event.tick - 200 }));

beforeEach(() => {
  server.on("GET", "/benches", { benches: [bench, other, fast, past] });
  server.on("GET", "/benches/other", other);
  server.on("GET", "/benches/other/events", { events: earlier });
  server.on("GET", "/recordings", { recordings });
  server.on("GET", "/runs", { runs });
});

async function open() {
  const board = connect(bench);
  await board.events(events);
  const shown = mount(<BehindView />);
  const sheet = within(await screen.findByRole("region", { name: "Branches and runs" }));
  await sheet.findByRole("option", { name: /^Heavier/ });
  return { board, ...shown, sheet };
}

const add = async ({ user, sheet }: Awaited<ReturnType<typeof open>>) => {
  await user.selectOptions(sheet.getByLabelText("Add"), sheet.getByRole("option", { name: /^Heavier/ }));
  return (await sheet.findByRole("textbox", { name: "Name of Heavier" })).closest("li") as HTMLElement;
};

it("offers benches and recordings of the same rate, and finished runs", async () => {
  const { sheet } = await open();
  const names = within(sheet.getByLabelText("Add"))
    .getAllByRole("option")
    .map((option) => option.textContent?.replace(/\s/g, " "));
  expect(names).toEqual([
    "choose what to compare with",
    expect.stringMatching(/^Heavier, at 20\.000 ms$/),
    "A recording",
    "A run",
  ]);
  expect(server.asked("GET", "/runs")[0].query).toEqual({ state: "done", limit: "1000" });
});

it("puts a bench behind the traces, at the same time, and takes it away", async () => {
  const opened = await open();
  const row = await add(opened);
  expect(row).toHaveTextContent("same time");
  expect(useBehind.getState().behind).toEqual([{ bench: "other", words: "Heavier", shift: 0 }]);
  await opened.user.click(within(row).getByRole("button", { name: "Take Heavier away" }));
  expect(useBehind.getState().behind).toEqual([]);
});

it("plays a recording, or carries a run out again, on a bench of its own as fast as it goes", async () => {
  server.on("POST", "/recordings/rec-1/replay", other);
  server.on("POST", "/benches/other/commands", { ok: true });
  server.on("GET", "/runs/run-1/scenario", "title = 'again'");
  server.on("POST", "/benches", { ...other, id: "again" });
  server.on("GET", "/benches/again", { ...other, id: "again", name: "Again" });
  const { user, sheet } = await open();
  await user.selectOptions(sheet.getByLabelText("Add"), "A recording");
  await sheet.findByRole("textbox", { name: "Name of Heavier" });
  expect(server.asked("POST", "/benches/other/commands")[0].body).toEqual({ kind: "time_scale", value: null });
  await user.selectOptions(sheet.getByLabelText("Add"), "A run");
  await sheet.findByRole("textbox", { name: "Name of Again" });
  expect(server.asked("POST", "/benches")[0].body).toEqual({ scenario: "title = 'again'", time_scale: null });
});

it("aligns the benches at their last faults, each with its shift and sign", async () => {
  const opened = await open();
  const row = await add(opened);
  await opened.user.selectOptions(opened.sheet.getByLabelText("Aligned at"), "the last fault of each");
  await waitFor(() => expect(row).toHaveTextContent("−2.000 ms"));
  server.on("GET", "/benches/other/events", { events: earlier.map((e) => ({ ...e, tick: e.tick + 300 })) });
  await opened.user.selectOptions(opened.sheet.getByLabelText("Aligned at"), "the same time");
  await waitFor(() => expect(row).toHaveTextContent("same time"));
  await opened.user.selectOptions(opened.sheet.getByLabelText("Aligned at"), "the last fault of each");
  await waitFor(() => expect(row).toHaveTextContent("+1.000 ms"));
  await opened.user.selectOptions(opened.sheet.getByLabelText("Aligned at"), "the last trip of each");
  await waitFor(() => expect(row).toHaveTextContent("same time")); // neither has tripped
});

it("shades the difference at first, and draws it on an axis when asked", async () => {
  const { user, sheet } = await open();
  await user.click(sheet.getByRole("checkbox", { name: "Shade the difference from the first" }));
  await user.click(sheet.getByRole("checkbox", { name: "Draw the difference on an axis of its own" }));
  expect(useBehind.getState()).toMatchObject({ shaded: false, difference: true });
});

it("renames a bench on the server, and closes it for good", async () => {
  server.on("PATCH", "/benches/other", other);
  server.on("DELETE", "/benches/other");
  const opened = await open();
  await add(opened);
  const name = opened.sheet.getByRole("textbox", { name: "Name of Heavier" });
  await opened.user.clear(name);
  await opened.user.type(name, "Heaviest{Enter}");
  await waitFor(() => expect(useBehind.getState().behind[0].words).toBe("Heaviest"));
  expect(server.asked("PATCH", "/benches/other")[0].body).toEqual({ name: "Heaviest" });
  await opened.user.click(await opened.sheet.findByRole("button", { name: "Close the bench Heaviest" }));
  await waitFor(() => expect(useBehind.getState().behind).toEqual([]));
  expect(server.asked("DELETE", "/benches/other")).toHaveLength(1);
});

it("goes to a bench behind", async () => {
  const opened = await open();
  const row = await add(opened);
  await opened.user.click(within(row).getByRole("button", { name: "Show" }));
  expect(window.location.search).toContain("bench=other");
});

it("keeps a bench that the server does not close, and says why", async () => {
  server.on("DELETE", "/benches/other", new Refusal(403, "That bench is not yours."));
  const opened = await open();
  await add(opened);
  await opened.user.click(opened.sheet.getByRole("button", { name: "Close the bench Heavier" }));
  expect(await screen.findByRole("alert")).toHaveTextContent("That bench is not yours.");
  expect(useBehind.getState().behind).toHaveLength(1);
});

it("takes no more than eight", async () => {
  const { sheet } = await open();
  const behind = Array.from({ length: 8 }, (_, i) => ({ bench: `b${i}`, words: `B${i}`, shift: 0 }));
  act(() => useBehind.setState({ behind }));
  expect(sheet.queryByLabelText("Add")).not.toBeInTheDocument();
  expect(sheet.getByText("8 are shown, which is the most.")).toBeVisible();
});
