import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useView } from "../../bench/view-store";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { jump } from "../../ui/hover";
import { BlindPanel } from "./blind-panel";

const { bench: hidden, asked, answered } = await recordedAnswer("blind");
const { bench: open } = await recordedBench("seven-steps");
const free = { ...open, id: hidden.id, blind: null } as typeof open;
const [given] = answered.answers;
const ANSWERS = ["healthy", "mass +5 %", "mass +10 %", "stiffness +5 %", "stiffness +10 %", "damping +30 %"];

beforeEach(() => {
  server.on("GET", "/benches/:id/blind", asked);
  server.on("POST", "/benches/:id/blind", hidden.blind);
  server.on("POST", "/benches/:id/blind/answer", given);
  server.on("DELETE", "/benches/:id/blind");
});

const panel = () => within(screen.getByRole("region", { name: "Blind diagnosis" }));
const plain = (element: Element) => element.textContent?.replace(/\s/g, " ");

it("hides the fault of a seed, the next time that of the next", async () => {
  connect(free);
  useView.setState({ sample: { diagnoser: "kalman", tick: 3 } });
  const { user } = mount(<BlindPanel />);
  await user.click(panel().getByRole("button", { name: "Hide a fault" }));
  expect(useView.getState().sample).toBeUndefined(); // which would tell a verdict
  await user.click(panel().getByRole("button", { name: "Hide a fault" }));
  expect(server.asked("POST", `/benches/${free.id}/blind`).map(({ body }) => body)).toEqual([
    { seed: 1, shows: false },
    { seed: 2, shows: false },
  ]);
});

it("asks with the hypotheses in words, and tells nothing of the fault before an answer", async () => {
  server.on("GET", "/benches/:id/blind", { ...answered, question: asked.question }); // an answer of an earlier question
  connect(hidden);
  mount(<BlindPanel />);
  await panel().findByText(/^A right answer that is 100 % sure/);
  expect(
    panel()
      .getAllByRole("radio")
      .map((radio) => plain(radio.closest("div")?.parentElement as Element)),
  ).toEqual(ANSWERS);
  for (const radio of panel().getAllByRole("radio")) expect(radio).not.toBeChecked();
  expect(screen.queryByText(/it is |kalman|Show the moment/)).not.toBeInTheDocument();
  expect(screen.queryByRole("table")).not.toBeInTheDocument();
  expect(panel().getByRole("button", { name: "Commit the answer" })).toBeDisabled();
});

it("says when the fault comes, and that it has come", async () => {
  const board = connect(hidden);
  mount(<BlindPanel />);
  expect(panel().getByText(/^If there is a fault, it comes before 8\.00\sms\./)).toBeVisible();
  board.status({ tick: hidden.blind?.by_tick });
  expect(panel().getByText(/^If there is a fault, it has come\./)).toBeVisible();
});

it("commits what was chosen with how sure one is, and then tells truth, points and verdicts", async () => {
  const board = connect(hidden);
  const { user } = mount(<BlindPanel />);
  await user.click(panel().getByRole("radio", { name: /^damping/ }));
  panel().getByRole("slider", { name: "How sure are you, percent" }).focus();
  await user.keyboard("{ArrowRight}{ArrowRight}");
  expect(plain(panel().getByText(/^How sure are you\?/))).toBe("How sure are you? 72 %");
  server.on("GET", "/benches/:id/blind", answered);
  await user.click(panel().getByRole("button", { name: "Commit the answer" }));
  const [{ body }] = server.asked("POST", `/benches/${hidden.id}/blind/answer`);
  expect(body).toEqual({ said: "b+30", confidence: 0.72 });
  board.hello(free);
  expect(await panel().findByText(/^Wrong: it is damping \+30\s%\. −67\spoints$/)).toBeVisible();
  expect(plain(panel().getByRole("status"))).toContain(
    "You said healthy with 70 %. The fault had not come; kalman said healthy.",
  );
  const [, row] = panel().getAllByRole("row");
  expect(within(row).getAllByRole("cell").map(plain)).toEqual(["healthy", "damping +30 %", "70 %", "−67"]);
});

it("is no surer than a guess at the least", async () => {
  connect(hidden);
  mount(<BlindPanel />);
  const slider = panel().getByRole("slider");
  expect(slider).toHaveAttribute("aria-valuemin", "17");
  expect(slider).toHaveAttribute("aria-valuemax", "100");
});

it("gives up without an answer", async () => {
  connect(hidden);
  const { user } = mount(<BlindPanel />);
  await user.click(panel().getByRole("button", { name: "Give up" }));
  expect(server.asked("DELETE", `/benches/${hidden.id}/blind`)).toHaveLength(1);
  expect(server.asked("POST", `/benches/${hidden.id}/blind/answer`)).toEqual([]);
});

it("says why an answer was refused, and lets it be committed again", async () => {
  server.on("POST", "/benches/:id/blind/answer", new Refusal(409, "The fault was answered already."));
  connect(hidden);
  const { user } = mount(<BlindPanel />);
  await user.click(panel().getByRole("radio", { name: "healthy" }));
  await user.click(panel().getByRole("button", { name: "Commit the answer" }));
  expect(await screen.findByText("The fault was answered already.")).toBeVisible();
  await waitFor(() => expect(panel().getByRole("button", { name: "Commit the answer" })).toBeEnabled());
});

it("leads to the moment at which the fault came, once it has", async () => {
  server.on("GET", "/benches/:id/blind", answered);
  const board = connect({ ...free, tick: 100 });
  const { user } = mount(<BlindPanel />);
  await panel().findByText(/^Wrong/);
  expect(panel().queryByRole("button", { name: /moment/ })).not.toBeInTheDocument();
  board.status({ tick: 400 });
  const went: unknown[] = [];
  const stop = jump.listen((to) => went.push(to));
  await user.click(panel().getByRole("button", { name: "Show the moment it came" }));
  stop();
  expect(went).toEqual([{ tick: 335 }]);
});

it("counts every answer, those that were not given too", async () => {
  const right = { ...given, id: "second", said: "b+30", confidence: 1, points: 100, took_ms: 3 };
  const none = { ...given, id: "third", said: null, confidence: null, points: 0, came_tick: null };
  server.on("GET", "/benches/:id/blind", { ...answered, answers: [given, none, right] });
  connect(free);
  mount(<BlindPanel />);
  expect(await panel().findByText(/^Right: it is damping \+30\s%\. 100\spoints$/)).toBeVisible();
  expect(plain(panel().getByRole("table").querySelector("caption") as Element)).toBe("3 answers, 11 points on average");
  expect(panel().getAllByRole("row")).toHaveLength(4);
  expect(panel().getByText("nothing")).toBeVisible();
});

it("has nothing to hide on a bench without a bank, and while a game is played", () => {
  const board = connect({ ...free, diagnosers: {} });
  mount(<BlindPanel />);
  expect(screen.getByText("Nothing to find on this bench")).toBeVisible();
  board.hello({ ...hidden, blind: { ...hidden.blind, game: { game: "g", seed: 1 } } } as typeof hidden);
  expect(screen.getByText("A game is played on this bench")).toBeVisible();
});
