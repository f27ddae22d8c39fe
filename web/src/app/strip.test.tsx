import { act, screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useLecture } from "../bench/lecture";
import { useNarrator } from "../bench/narrator";
import { useView } from "../bench/view-store";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { resize } from "../testing/jsdom-gaps";
import { logEntry } from "../testing/log-entry";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { Strip } from "./strip";

const first = await recordedBench("first-look");
const seven = await recordedBench("seven-steps");
const catalog = await recordedAnswer("catalog");
const bench = { ...first.bench, earliest_tick: 0 };
const steps = { ...seven.bench, earliest_tick: 0 };

beforeEach(() => void server.on("GET", "/catalog", catalog));

const region = (name: string) => screen.queryByRole("region", { name });
const regions = () => screen.getAllByRole("region").map((one) => one.getAttribute("aria-label"));
const sentence = { tick: 1800, text: "Mass is added", kind: "inject", signals: [], span: [1790, 1900] };
const tell = { type: "narration", after: 0, sentences: [sentence] } as never;

it("shows a first visitor what to try next, beside the bench in a sentence and its timeline; the list is on demand", async () => {
  const board = connect(bench);
  const { user } = mount(<Strip />);
  expect(regions()).toEqual(["Try this", "What happens now", "Timeline"]);
  expect(region("Try this")).toHaveTextContent(/Try this \(1 of 3\): inject Added mass \+5\s% under Faults/);
  expect(region("What happens now")).toHaveTextContent(/^A live comb resonator/);
  expect(screen.queryByRole("list")).not.toBeInTheDocument();
  await board.events(first.events.map((event) => (event.kind === "inject" ? { ...event, actor: "page" } : event)));
  expect(region("Try this")).toHaveTextContent(/Try this \(3 of 3\): change the controller/);
  await user.click(screen.getByRole("button", { name: "All hints" }));
  const hints = within(await screen.findByRole("region", { name: "Things to try" })).getAllByRole("listitem");
  expect(hints.map(({ dataset }) => dataset.done)).toEqual(["true", "true", "false"]);
  await user.click(screen.getByRole("button", { name: "Dismiss the hints" }));
  expect(region("Try this")).not.toBeInTheDocument();
});

it("shows which step of a scenario comes next in place of the hints", async () => {
  const board = connect(steps);
  const { user } = mount(<Strip />);
  await board.events(seven.events);
  expect(await screen.findByRole("region", { name: "Steps of the scenario" })).toHaveTextContent(/^2 of 7: Added mass/);
  expect(region("Try this")).not.toBeInTheDocument();
  await user.click(screen.getByRole("button", { name: "Skip" }));
  expect(board.commands).toEqual([{ kind: "fast_forward" }]);
});

it("keeps the list of findings closed when the scenario ends", async () => {
  const board = connect({ ...steps, pending: [], tick: 9000 });
  const { user } = mount(<Strip />);
  await board.events([
    ...seven.events,
    logEntry({ seq: 900, tick: 2000, kind: "inject", actor: "scenario", command: { fault: "damping", severity: 0.3 } }),
  ]);
  const found = await screen.findByRole("button", { name: "Findings" });
  expect(region("Steps of the scenario")).toHaveTextContent("ended");
  expect(screen.queryByRole("list")).not.toBeInTheDocument();
  await user.click(found);
  expect(await screen.findByRole("list", { name: "Findings at each step" })).toBeVisible();
});

it("shows the newest sentence of the narrator, and all of them on demand", async () => {
  const board = connect(bench);
  const { user } = mount(<Strip />);
  board.say(tell);
  expect(region("What happens now")).toHaveTextContent("Mass is added");
  await user.click(screen.getByRole("button", { name: "All hints" }));
  expect(await screen.findByRole("list", { name: "Sentences of the narrator, newest last" })).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Narrator off (Q)" }));
  expect(region("What happens now")).not.toBeInTheDocument();
});

it("leaves the time of a replay to the bar of the replay", () => {
  connect({ ...bench, replay_of: "recording-first" });
  mount(<Strip />);
  expect(regions()).toEqual(["What happens now"]);
});

it("says which moment of the past is shown, with the way back", () => {
  connect({ ...bench, origin: { bench: "now", tick: 2000, is_past: true } as never });
  mount(<Strip />);
  expect(region("Timeline")).toHaveTextContent(/As it was at 20\.000\sms/);
  expect(screen.getByRole("button", { name: "Back to now" })).toBeVisible();
});

it("shows an audience the sentence alone, or nothing", () => {
  const board = connect(steps);
  mount(<Strip />);
  board.say(tell);
  act(() => useView.setState({ present: true }));
  expect(regions()).toEqual(["What happens now"]);
  expect(screen.getAllByRole("button")).toHaveLength(1); // the sentence
  act(() => useNarrator.setState({ on: false }));
  expect(screen.queryByRole("contentinfo")).not.toBeInTheDocument();
});

it("shows neither steps nor hints while a lecture asks what comes next", async () => {
  const board = connect(steps);
  mount(<Strip />);
  await board.events(seven.events);
  await screen.findByRole("region", { name: "Steps of the scenario" });
  act(() => useLecture.setState({ lecture: { id: "l", title: "", script: [] } as never }));
  expect(regions()).toEqual(["What happens now", "Timeline"]);
});

it("offers a watcher neither hints nor the time", () => {
  be("watcher");
  connect(bench);
  mount(<Strip />);
  expect(regions()).toEqual(["What happens now"]);
});

const verdict = {
  ...sentence,
  text: "At 20.300 ms the bank now favours mass +5 % (98 %). Correct; first chosen at 20.26 ms. The model misses by 5 nm.",
};

/** Lay a caption out: every sentence takes a line of 18 px. */
function lineUp(caption: HTMLElement) {
  const spans = [...caption.getElementsByTagName("span")];
  for (const [i, span] of spans.entries()) span.getBoundingClientRect = () => ({ bottom: 18 * (i + 1) }) as DOMRect;
  (caption.firstElementChild as HTMLElement).style.lineHeight = "18px";
  resize(400, 36);
}

it("ends no caption within a sentence: the sentences without room are on demand", async () => {
  const board = connect(bench);
  const { user } = mount(<Strip />);
  board.say({ type: "narration", after: 0, sentences: [verdict] } as never);
  const place = region("What happens now") as HTMLElement;
  lineUp(place);
  const caption = within(place);
  expect(caption.getByText(/^At 20\.300 ms the bank/)).toBeVisible();
  expect(caption.getByText(/^Correct; first chosen at 20\.26 ms\.$/)).toBeVisible();
  expect(caption.getByText(/^The model misses/)).not.toBeVisible();
  await user.click(caption.getByRole("button", { name: "More sentences" }));
  expect(caption.getByText(/^The model misses/)).toBeVisible();
  await user.click(caption.getByRole("button", { name: "Fewer sentences" }));
  expect(caption.getByText(/^The model misses/)).not.toBeVisible();
});

it("shows the first sentence of a caption whole, and has no button where all have room", () => {
  const board = connect(bench);
  mount(<Strip />);
  board.say(tell);
  expect(within(region("What happens now") as HTMLElement).getAllByRole("button")).toHaveLength(1);
});
