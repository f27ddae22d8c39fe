import { act, screen, within } from "@testing-library/react";
import { expect, it } from "vitest";
import { useMe } from "../../api/me";
import type { Sentence } from "../../api/types";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { jump } from "../../ui/hover";
import { NarratorPanel } from "./narrator-panel";

const { bench } = await recordedBench("first-look");
const sentences = Array.from(
  { length: 15 },
  (_, i) =>
    ({
      tick: 100 * i,
      text: `Sentence ${i + 1} <b>`,
      kind: "inject",
      signals: [],
      span: [100 * i - 10, 100 * i + 10],
    }) as unknown as Sentence,
);

/** The panel of a bench with sentences of its narrator. */
function mountPanel(of = bench, told = sentences, after = 0) {
  const board = connect(of);
  const { user } = mount(<NarratorPanel />);
  board.say({ type: "narration", after, sentences: told } as never);
  return { board, user };
}
const list = () => within(screen.getByRole("list", { name: "Sentences of the narrator, newest last" }));

it("says that there is nothing to tell yet", () => {
  connect(bench);
  mount(<NarratorPanel />);
  expect(screen.getByText("No events yet")).toBeVisible();
});

it("lists every sentence, the newest last", () => {
  mountPanel();
  expect(
    list()
      .getAllByRole("button")
      .map((one) => one.textContent),
  ).toEqual(sentences.map(({ text }) => text));
  expect(list().getAllByRole("button").at(-1)).toHaveAttribute("aria-current", "step");
});

it("says how many sentences lie before them", () => {
  mountPanel(bench, sentences, 7);
  expect(list().getByText(/^Earlier: 7\ssentences$/)).toBeVisible();
});

it("leaves out the sentences of a run that began again", () => {
  const { board } = mountPanel();
  board.say({ type: "narration", after: 2, sentences: [] } as never);
  expect(list().getAllByRole("button")).toHaveLength(2);
});

it("marks a sentence that is clicked, and takes the scopes there", async () => {
  const { user } = mountPanel();
  const went: unknown[] = [];
  const stop = jump.listen((to) => went.push(to));
  await user.click(list().getByText("Sentence 4 <b>"));
  stop();
  expect(went).toEqual([{ tick: 300 }]);
  expect(list().getByText("Sentence 4 <b>")).toHaveAttribute("data-chosen", "true");
  expect(list().getByText("Sentence 5 <b>")).toHaveAttribute("data-chosen", "false");
});

it("lists what is to come in a replay, and goes there first", async () => {
  const { board, user } = mountPanel({ ...bench, tick: 450, replay_of: "recording-1" });
  expect(list().getByText("Sentence 5 <b>")).toHaveAttribute("data-ahead", "false");
  expect(list().getByText("Sentence 6 <b>")).toHaveAttribute("data-ahead", "true");
  expect(list().getByText("Sentence 5 <b>")).toHaveAttribute("aria-current", "step");
  await user.click(list().getByText("Sentence 9 <b>"));
  expect(board.commands).toEqual([{ kind: "seek", tick: 790 }]);
});

it("tells nothing while a vote is open", () => {
  be("student");
  mountPanel();
  act(() => useMe.setState(({ me }) => ({ me: me && { ...me, vote: { state: "open" } as never } })));
  expect(screen.getByText("Not while a vote is open")).toBeVisible();
  expect(screen.queryByText("Sentence 4 <b>")).not.toBeInTheDocument();
});

it("copies the command that a sentence tells of", async () => {
  const { board } = mountPanel(bench, [{ ...sentences[3], span: [300, 300] }, sentences[4]]);
  expect(screen.queryByRole("button", { name: /^Copy/ })).not.toBeInTheDocument();
  const inject = {
    seq: 9,
    tick: 300,
    kind: "inject",
    text: "inject mass",
    command: { fault: "added_mass", severity: 0.05 },
  };
  await board.events([inject, { ...inject, seq: 10, tick: 390 }] as never);
  expect(screen.getAllByRole("button", { name: /^Copy/ })).toHaveLength(1);
});
