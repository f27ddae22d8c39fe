import { act, screen, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { useLecture } from "../../bench/lecture";
import { useView } from "../../bench/view-store";
import { showVote } from "../../bench/vote";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { KeySheet } from "../key-sheet";
import { useKeys } from "../use-keys";
import { LectureStrip } from "./lecture-strip";
import { Presenter } from "./presenter";

const { lecture: recorded } = await recordedAnswer("lectures");
const { open, revealed } = await recordedAnswer("votes");
const { bench } = await recordedBench("first-look");
const AT = 1;
const vote = { text: "Which is it?", answers: ["heavier", "stiffer"], diagnoser: "", right: "heavier" };
const lecture = { ...recorded, script: recorded.script.map((cue, at) => (at === AT ? { ...cue, vote } : cue)) };

function Page() {
  useKeys();
  return (
    <>
      <LectureStrip />
      <KeySheet />
    </>
  );
}

beforeEach(() => {
  server.on("GET", "/classes", { classes: [] });
  server.on("GET", "/votes", { votes: [] });
  server.on("POST", "/votes", open);
  server.on("POST", "/votes/:id/reveal", revealed);
  server.on("POST", "/lectures/:id/cues/:number", { bench, tick: 20, digest: "" });
});

function begin(at = AT) {
  const board = connect(bench);
  useLecture.setState({ lecture, at, tick: 20, stage: bench.id, began: 1 });
  return board;
}

const cuesAsked = () => server.requests.flatMap(({ path }) => /\/cues\/(\d+)$/.exec(path)?.[1] ?? []);

it.each([
  [" ", AT + 2],
  ["{PageDown}", AT + 2],
  ["{ArrowRight}", AT + 2],
  ["{PageUp}", AT],
  ["{ArrowLeft}", AT],
])("the key %s leads to another cue", async (key, number) => {
  begin();
  const { user } = mount(<Page />);
  await user.keyboard(key);
  await vi.waitFor(() => expect(cuesAsked()).toEqual([String(number)]));
});

it("R runs the bench, W asks why, A opens the vote and X reveals it", async () => {
  const board = begin();
  const { user } = mount(<Page />);
  await user.keyboard("r");
  expect(board.commands).toEqual([{ kind: "start" }]);
  await user.keyboard("w");
  expect(useView.getState().sample).toMatchObject({ diagnoser: "kalman" });
  await user.keyboard("x");
  await user.keyboard("a");
  await vi.waitFor(() => expect(server.asked("POST", "/votes")).toHaveLength(1));
  expect(server.asked("POST", `/votes/${open.id}/reveal`)).toHaveLength(0);
  act(() => showVote(open));
  await user.keyboard("x");
  await vi.waitFor(() => expect(server.asked("POST", `/votes/${open.id}/reveal`)).toHaveLength(1));
});

it("asks the vote of a cue once in a lecture, and anew in the next one", async () => {
  begin();
  const { user } = mount(<Page />);
  await user.keyboard("a");
  await vi.waitFor(() => expect(server.asked("POST", "/votes")).toHaveLength(1));
  server.on("GET", "/votes", {
    votes: [{ ...revealed, class_id: null, question: { ...revealed.question, text: vote.text } }],
  });
  const asked = () => server.asked("GET", "/votes").length;
  const before = asked();
  await user.keyboard("a");
  await vi.waitFor(() => expect(asked()).toBeGreaterThan(before));
  expect(server.asked("POST", "/votes")).toHaveLength(1);
  act(() => useLecture.setState({ began: 2 }));
  await user.keyboard("a");
  await vi.waitFor(() => expect(server.asked("POST", "/votes")).toHaveLength(2));
});

it("takes the vote off a phone with the next cue", async () => {
  begin();
  useView.setState({ extra: "vote" });
  const { user } = mount(<Page />);
  await user.keyboard("{PageDown}");
  await vi.waitFor(() => expect(useView.getState().extra).toBe(""));
});

it("lists every key of the lecture in the sheet of keys, and the other use of such a key not at all", async () => {
  begin();
  const { user } = mount(<Page />);
  await user.keyboard("?");
  const rows = within(await screen.findByRole("dialog")).getAllByRole("definition");
  const said = rows.map((row) => row.textContent);
  for (const does of [
    "next cue",
    "cue before",
    "run or pause the bench",
    "open the vote of the cue",
    "reveal the votes",
  ])
    expect(said).toContain(does);
  expect(said.filter((does) => does === "why the newest verdict")).toHaveLength(1);
  expect(said).toContain("notes of the speaker in a window of their own");
  expect(said).not.toContain("run or pause");
});

it("keeps the notes off the page until they are asked for", async () => {
  begin();
  const { user } = mount(<Page />);
  expect(screen.queryByRole("region", { name: "Notes of the speaker" })).not.toBeInTheDocument();
  await user.click(screen.getByRole("button", { name: "Notes" }));
  expect(await screen.findByRole("region", { name: "Notes of the speaker" })).toBeVisible();
});

it("opens the notes in a window by I", async () => {
  const opened = vi.spyOn(window, "open").mockReturnValue(null);
  begin();
  const { user } = mount(<Page />);
  await user.keyboard("i");
  expect(opened).toHaveBeenCalledWith("./?notes=1", "combbench-notes", expect.any(String));
});

it("shows the notes in their window, and runs a key that is pressed there", async () => {
  const board = begin();
  const { user } = mount(
    <>
      <LectureStrip />
      <Presenter />
    </>,
  );
  const name = `${AT + 1} of ${lecture.script.length} ${lecture.script[AT].title}`;
  expect(await screen.findByRole("heading", { level: 1, name })).toBeVisible();
  expect(screen.getByRole("region", { name: "Notes of the speaker" })).toBeVisible();
  await user.keyboard("r");
  await vi.waitFor(() => expect(board.commands).toEqual([{ kind: "start" }]));
});

it("has the notes of any lecture by themselves, as for a phone", async () => {
  window.history.replaceState(null, "", `./?notes=${lecture.id}`);
  server.on("GET", "/lectures/:id", lecture);
  const { user } = mount(<Presenter />);
  const title = await screen.findByRole("heading", { level: 1 });
  expect(title).toHaveTextContent(`1 of ${lecture.script.length} ${lecture.script[0].title}`);
  await user.click(screen.getByRole("button", { name: "Next" }));
  expect(title).toHaveTextContent(`2 of ${lecture.script.length}`);
  await user.click(screen.getByRole("button", { name: "Back" }));
  await user.click(screen.getByRole("button", { name: "Back" }));
  expect(title).toHaveTextContent("1 of");
  window.history.replaceState(null, "", "./");
});
