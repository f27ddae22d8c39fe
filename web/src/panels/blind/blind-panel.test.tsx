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

const panel = () => within(screen.getByRole("region", { name: "Hidden fault" }));
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
  const [, row] = within(panel().getByRole("table", { name: /answer/ })).getAllByRole("row");
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
  const answers = panel().getByRole("table", { name: /^3.answers, 11.points on average$/ });
  expect(within(answers).getAllByRole("row")).toHaveLength(4);
  expect(panel().getByText("nothing")).toBeVisible();
});

it("begins with the button that hides a fault, and keeps confidence and Commit beside what scrolls", () => {
  const board = connect(free);
  mount(<BlindPanel />);
  expect(panel().getAllByRole("button")[0]).toHaveAccessibleName("Hide a fault");
  expect(screen.getByRole("region", { name: "Hidden fault" }).firstElementChild).toContainElement(
    panel().getByRole("button", { name: "Hide a fault" }),
  );
  board.hello(hidden);
  const scrolls = screen.getByTestId("question");
  expect(scrolls).toContainElement(panel().getAllByRole("radio")[0]);
  for (const one of [panel().getByRole("slider"), panel().getByRole("button", { name: "Commit the answer" })])
    expect(scrolls).not.toContainElement(one);
});

const SHOWN = { f0_hz: 2484, quality_factor: 20, rest_um_per_v: 0.3, peak_um_per_v: 6 };
const ended = (truth: string, faulty: Partial<typeof SHOWN>) => {
  const { said, confidence } = { said: truth, confidence: 0.7 };
  const told = { ...given, truth, said, confidence, healthy: SHOWN, faulty: { ...SHOWN, ...faulty } };
  server.on("GET", "/benches/:id/blind", { ...answered, answers: [told] });
  connect(free);
  return mount(<BlindPanel />);
};

it.each([
  ["m+10", { f0_hz: 2368.4 }, /mass, not stiffness/, ["Resonance f₀ 2.484 kHz 2.368 kHz −4.7 %"]],
  [
    "k+10",
    { f0_hz: 2605.3, rest_um_per_v: 0.27273 },
    /stiffness, not mass/,
    ["Resonance f₀ 2.484 kHz 2.605 kHz +4.9 %", /^Gain at low frequencies .* −9.1 %$/],
  ],
  [
    "b+30",
    { quality_factor: 15.4, peak_um_per_v: 4.62 },
    /its peak has another height and width/,
    ["Quality factor 20.00 15.40 −23.0 %", /^Gain at the peak .* −23.0 %$/],
  ],
  ["healthy", {}, /a sweep finds every figure where it was/, []],
] as const)("says which measurement would have told %s, with its figures", async (truth, faulty, said, moved) => {
  const { user } = ended(truth, faulty);
  expect(await panel().findByText(said)).toBeVisible();
  const rows = within(panel().getByRole("table", { name: "Results of a sweep" }))
    .getAllByRole("row")
    .slice(1);
  const shown = rows.filter((row) => row.dataset.moved === "true").map((row) => [...row.children].map(plain).join(" "));
  expect(shown).toHaveLength(moved.length);
  moved.forEach((text, i) => void expect(shown[i]).toMatch(text));
  await user.click(panel().getByRole("button", { name: "Sweep the device" }));
  expect(useView.getState().extra).toBe("identify");
});

it("names the measurement on a gyroscope, which no sweep measures", async () => {
  const factors = { ...given.factors, "sense+1": { second_stiffness: 1.01 } };
  const told = { ...given, truth: "sense+1", factors, healthy: null, faulty: null };
  server.on("GET", "/benches/:id/blind", { ...answered, answers: [told] });
  connect(free);
  mount(<BlindPanel />);
  expect(await panel().findByText(/along y: its resonance moves/)).toBeVisible();
  expect(panel().queryByRole("button", { name: "Sweep the device" })).not.toBeInTheDocument();
});

it("has nothing to hide on a bench without a bank, and while a game is played", () => {
  const board = connect({ ...free, diagnosers: {} });
  mount(<BlindPanel />);
  expect(screen.getByText("Nothing to find on this bench")).toBeVisible();
  board.hello({ ...hidden, blind: { ...hidden.blind, game: { game: "g", seed: 1 } } } as typeof hidden);
  expect(screen.getByText("A game is played on this bench")).toBeVisible();
});
