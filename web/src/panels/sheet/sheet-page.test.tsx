import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { SheetList } from "./sheet-list";
import { SheetPage } from "./sheet-page";

const sheet = await recordedAnswer("sheet");
const { sheets: cards } = await recordedAnswer("sheets");
const { bench } = await recordedBench("first-look");
const [open, next, ...rest] = sheet.sections;
const step = {
  ...open.step,
  id: "amplitude",
  kind: "question" as const,
  question: "How large?",
  unit: "um",
  tries_left: 2,
};
/** The second step is open: it asks for a number. */
const asking = {
  ...sheet,
  sections: [{ ...open, state: "done" }, { ...next, state: "open", step: { ...step, conditions: [] } }, ...rest],
};
const STEPS = "/sheets/first-look/steps/amplitude";

beforeEach(() => {
  connect(bench);
  server.on("GET", "/sheets/first-look", asking);
  server.on("GET", "/recordings", { recordings: [] });
  server.on("POST", `${STEPS}/:what`, { ...asking, earned: 2 });
});

async function mountPage() {
  const onLeave = vi.fn();
  const shown = mount(<SheetPage id="first-look" onLeave={onLeave} />);
  await screen.findByRole("heading", { name: sheet.title });
  return { ...shown, onLeave };
}

it("shows every section, which is open, the points and where to hand in", async () => {
  server.on("GET", "/sheets/first-look", sheet);
  await mountPage();
  const headings = screen.getAllByRole("heading", { level: 3 }).map((one) => one.childNodes[0].textContent);
  expect(headings).toEqual(sheet.sections.map(({ heading }) => heading));
  expect(screen.getByRole("listitem", { current: "step" })).toHaveTextContent("Let it run");
  expect(screen.getByTestId("sheet-points")).toHaveTextContent("0 of 11 points");
  expect(screen.getByText(/^Amplitude of the displacement/)).toBeVisible();
  expect(screen.getByRole("link", { name: "Hand in" })).toHaveAttribute("href", "./api/v1/sheets/first-look/report");
});

it("has the way to hand in below the last section too once all steps are done", async () => {
  const sections = sheet.sections.map((section) => ({ ...section, state: "done" as const }));
  server.on("GET", "/sheets/first-look", { ...sheet, sections, done: true });
  await mountPage();
  const link = screen.getAllByRole("link", { name: "Hand in" })[1];
  const last = screen.getAllByRole("listitem").at(-1) as HTMLElement;
  expect(last.compareDocumentPosition(link) & Node.DOCUMENT_POSITION_FOLLOWING).toBeTruthy();
  expect(screen.getByText(/^All steps are done/)).toBeVisible();
});

it("sends an answer, and shows the points that it earns", async () => {
  const { user } = await mountPage();
  expect(screen.getByText(/2\sattempts left\.$/)).toBeVisible();
  await user.type(screen.getByRole("textbox", { name: "How large?" }), "3 µm");
  await user.click(screen.getByRole("button", { name: "Answer" }));
  expect(server.asked("POST", `${STEPS}/answer`)[0].body).toEqual({ answer: "3 µm" });
  await waitFor(() => expect(screen.getByTestId("sheet-points")).toHaveTextContent("2 of 11 points"));
});

it("says at its field why an answer cannot be read", async () => {
  server.on("POST", `${STEPS}/answer`, new Refusal(422, "answer: has no unit", { hint: "Write 3 µm." }));
  const { user } = await mountPage();
  await user.type(screen.getByRole("textbox", { name: "How large?" }), "3");
  await user.click(screen.getByRole("button", { name: "Answer" }));
  expect(await screen.findByText("The answer has no unit; Write 3 µm.")).toBeVisible();
  expect(screen.getByRole("textbox", { name: "How large?" })).toBeInvalid();
});

it("hides the fault of a blind step, and no second one while it is hidden", async () => {
  const blind = { ...step, kind: "blind" as const, question: "" };
  const section = { ...next, state: "open" as const, step: { ...blind, conditions: [] } };
  server.on("GET", "/sheets/first-look", { ...asking, sections: [{ ...open, state: "done" }, section, ...rest] });
  const { user } = await mountPage();
  await user.click(screen.getByRole("button", { name: "Hide a fault" }));
  expect(server.asked("POST", `${STEPS}/hide`)).toHaveLength(1);
  connect({ ...bench, blind: { id: "q", game: null, answers: [], factors: [], shows: [], began_tick: 0, by_tick: 9 } });
  await waitFor(() => expect(screen.queryByRole("button", { name: "Hide a fault" })).toBeNull());
});

it("asks for a hint", async () => {
  const { user } = await mountPage();
  await user.click(screen.getByRole("button", { name: "Hint, free" }));
  expect(server.asked("POST", `${STEPS}/hint`)).toHaveLength(1);
});

it("makes the bench again when it is gone, and starts over for a teacher alone", async () => {
  server.on("GET", "/sheets/first-look", { ...asking, bench: null });
  server.on("POST", "/sheets/first-look/begin", asking);
  const { user, onLeave, unmount } = await mountPage();
  await user.click(screen.getByRole("button", { name: "Make it again" }));
  expect(server.asked("POST", "/sheets/first-look/begin")).toHaveLength(1);
  await user.click(screen.getByRole("button", { name: "All sheets" }));
  expect(onLeave).toHaveBeenCalledTimes(1);
  expect(screen.getByRole("button", { name: "Start over…" })).toBeVisible();
  unmount();
  be("student");
  await mountPage();
  expect(screen.queryByRole("button", { name: "Start over…" })).not.toBeInTheDocument();
});

it("lists the sheets, the last included, and begins one or goes on with it", async () => {
  server.on("POST", "/sheets/:id/begin", sheet);
  const changed = vi.fn();
  const { user } = mount(<SheetList cards={cards} onChanged={changed} />);
  expect(screen.getAllByRole("listitem")).toHaveLength(cards.length);
  expect(within(screen.getAllByRole("listitem")[0]).getByText(/step 2 of 7, 1 of 11 points/)).toBeVisible();
  await user.click(screen.getByRole("button", { name: `Go on with ${cards[0].title}` }));
  await user.click(screen.getByRole("button", { name: `Begin ${cards[1].title}` }));
  expect(server.asked("POST", `/sheets/${cards[1].id}/begin`)).toHaveLength(1);
  await waitFor(() => expect(changed).toHaveBeenCalledTimes(2));
});

it("says with its file what is wrong with a sheet from disk", async () => {
  server.on("POST", "/sheets", new Refusal(422, "line 3: no such step", { hint: "See the guide" }));
  const { user } = mount(<SheetList cards={cards} onChanged={() => undefined} />);
  const file = new File(["# Mine"], "mine.md", { type: "text/markdown" });
  await user.upload(screen.getByLabelText("Sheet file"), file);
  expect(await screen.findByRole("alert")).toHaveTextContent("mine.md: line 3: no such step. See the guide");
  expect(server.asked("POST", "/sheets")[0].body).toEqual({ text: "# Mine" });
});
