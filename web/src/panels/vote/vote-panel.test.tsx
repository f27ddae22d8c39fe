import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { VotePanel } from "./vote-panel";

const { open, revealed } = await recordedAnswer("votes");
const { class: group } = await recordedAnswer("class");
const { bench } = await recordedBench("first-look");

beforeEach(() => {
  server.on("GET", "/classes", { classes: [] });
  server.on("GET", "/votes", { votes: [] });
  server.on("POST", "/votes", open);
  server.on("POST", "/votes/:id/:what", revealed);
  server.on("PUT", "/votes/:id/hands", open);
  server.on("DELETE", "/votes/:id");
});

it("asks with the lanes of the bank, and a moment within the next 20 ms", async () => {
  server.on("GET", "/classes", { classes: [group] });
  connect(bench);
  const { user } = mount(<VotePanel />);
  await user.click(await screen.findByRole("button", { name: "Open the vote" }));
  expect(server.asked("POST", "/votes")[0].body).toEqual({
    class_id: group.id,
    text: "Which lane rises, and when?",
    answers: bench.diagnosers.kalman.names,
    diagnoser: "kalman",
    when: { from_ms: 20, until_ms: 40 },
    right: "",
  });
});

it("asks the room a question with two answers of one's own, and not with one", async () => {
  connect(bench);
  const { user } = mount(<VotePanel />);
  await user.selectOptions(await screen.findByLabelText("Answers"), "two to six of my own");
  const lines = screen.getByLabelText("One answer in each line");
  await user.type(lines, "yes");
  expect(screen.getByRole("button", { name: "Open the vote" })).toBeDisabled();
  await user.type(lines, "{Enter}no");
  await user.click(screen.getByRole("button", { name: "Open the vote" }));
  expect(server.asked("POST", "/votes")[0].body).toMatchObject({ class_id: null, answers: ["yes", "no"], when: null });
});

it("counts the hands of the room, and reveals", async () => {
  server.on("GET", "/votes", { votes: [{ ...open, voted: 4 }] });
  const { user } = mount(<VotePanel />);
  expect(await screen.findByText(/^4\shands counted$/)).toBeVisible();
  const hands = screen.getByRole("textbox", { name: "stiffer" });
  await user.type(hands, "12", { initialSelectionStart: 0, initialSelectionEnd: 1 });
  expect(server.asked("PUT", "/votes/vote-1/hands").at(-1)?.body).toEqual({ counts: [0, 12] });
  await user.click(screen.getByRole("button", { name: "Reveal" }));
  expect(server.asked("POST", "/votes/vote-1/reveal")).toHaveLength(1);
});

it("tells nothing of the answers of a class before it reveals, and closes the vote", async () => {
  server.on("GET", "/classes", { classes: [group] });
  server.on("GET", "/votes", { votes: [{ ...open, class_id: group.id, voted: 1 }] });
  const { user } = mount(<VotePanel />);
  expect(await screen.findByText("1 of 2 have voted")).toBeVisible();
  expect(screen.queryByRole("meter")).not.toBeInTheDocument();
  expect(screen.queryByText("right")).not.toBeInTheDocument();
  await user.click(screen.getByRole("button", { name: "Close" }));
  expect(server.asked("POST", "/votes/vote-1/close")).toHaveLength(1);
});

it("shows what was said, which is right, and asks another question", async () => {
  server.on("GET", "/votes", { votes: [revealed] });
  const { user } = mount(<VotePanel />);
  const list = within(await screen.findByRole("list", { name: "Results" }));
  expect(list.getAllByRole("listitem").map((row) => row.textContent?.replace(/\s/g, " "))).toEqual([
    "heavier right3 votes, 75 %",
    "stiffer1 vote, 25 %",
  ]);
  await user.click(screen.getByRole("button", { name: "Another question" }));
  expect(server.asked("DELETE", "/votes/vote-1")).toHaveLength(1);
});

it("says why a vote did not open, and lets only a teacher ask", async () => {
  server.on("POST", "/votes", new Refusal(409, "A vote is open."));
  connect(bench);
  const { user, unmount } = mount(<VotePanel />);
  await user.click(await screen.findByRole("button", { name: "Open the vote" }));
  expect(await screen.findByText("A vote is open.")).toBeVisible();
  unmount();
  be("student");
  mount(<VotePanel />);
  expect(screen.getByText("The teacher asks; the question appears here.")).toBeVisible();
  expect(screen.queryByRole("button", { name: "Open the vote" })).not.toBeInTheDocument();
});
