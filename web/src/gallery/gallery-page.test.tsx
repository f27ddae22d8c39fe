import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { micro } from "../api/micro";
import { openPlace, useView } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { GalleryPage } from "./gallery-page";

const { cards, figures } = await recordedAnswer("gallery");
const { lectures } = await recordedAnswer("lectures");
const { bench } = await recordedBench("first-look");
const [first, study, ...rest] = cards;
const done = { ...first, state: "done" as const, run: "run-1", ok: true };
const library = [done, study, ...rest];

beforeEach(() => {
  server.on("GET", "/gallery", { cards: library, figures: { ...figures, is_making: false } });
  server.on("GET", "/lectures", { lectures });
});

/** One experiment is under way, after which is asked often. */
const busy = library.map((card) => (card.id === rest[0].id ? { ...card, state: "running", progress: 0.4 } : card));

async function mountGallery() {
  const shown = mount(<GalleryPage />);
  const list = await screen.findByRole("list", { name: "Experiments" });
  const entries = () => [...list.children].map((entry) => entry.querySelector("small")?.textContent?.split(" ")[0]);
  const entry = (id: string) => within(list.children[entries().indexOf(id)] as HTMLElement);
  return { ...shown, entries, entry };
}

it("shows every experiment, how many there are, and how many are under way", async () => {
  server.on("GET", "/gallery", { cards: busy, figures: { ...figures, is_making: false } });
  const { entries, entry } = await mountGallery();
  expect(entries()).toEqual(library.map(({ id }) => id));
  expect(screen.getByText(/^6\sexperiments, 1 under way$/)).toBeVisible();
  expect(entry(study.id).getByText("Not measured yet")).toBeVisible();
  expect(entry(study.id).getByText(/^0.2.µm of a 5.µm wide beam is 12.% of its stiffness/)).toBeVisible();
  expect(entry(rest[0].id).getByRole("progressbar")).toHaveAttribute("aria-valuenow", "40");
});

it("names the cards in sight when it asks again, so that their figures are made first", async () => {
  const { user } = await mountGallery();
  expect(server.asked("GET", "/gallery")[0].query).toEqual({});
  server.on("POST", "/runs", { id: "run-2" });
  await user.type(screen.getByRole("searchbox"), "narrower");
  await user.click(screen.getByRole("button", { name: /narrower headless$/ }));
  await waitFor(() => expect(server.asked("GET", "/gallery")).toHaveLength(2));
  expect(server.asked("GET", "/gallery")[1].query).toEqual({ first: study.id });
});

it("names every card in sight, in their order", async () => {
  const { user } = await mountGallery();
  server.on("POST", "/runs", { id: "run-2" });
  await user.click(screen.getByRole("button", { name: /narrower headless$/ }));
  await waitFor(() => expect(server.asked("GET", "/gallery")).toHaveLength(2));
  expect(server.asked("GET", "/gallery")[1].query).toEqual({ first: library.map(({ id }) => id).join() });
});

it("runs an experiment headless, and shows the words of a refusal", async () => {
  server.on("POST", "/runs", new Refusal(429, "Too many runs wait."));
  const { user } = await mountGallery();
  await user.click(screen.getByRole("button", { name: /narrower headless$/ }));
  expect(server.asked("POST", "/runs")[0].body).toEqual({ scenario: study.id });
  expect(await screen.findByText("Too many runs wait.")).toBeVisible();
});

it("opens an experiment live, and no study", async () => {
  connect(bench);
  server.on("POST", "/benches", { ...bench, id: "made" });
  const { user, entry } = await mountGallery();
  useView.setState({ page: "gallery" });
  expect(entry(study.id).queryByRole("button", { name: /live$/ })).not.toBeInTheDocument();
  await user.click(entry(first.id).getByRole("button", { name: /live$/ }));
  expect(server.asked("POST", "/benches")[0].body).toEqual({ scenario: first.id, paused: false, quiet_lead: true });
  await waitFor(() => expect(window.location.search).toBe("?bench=made"));
  expect(useView.getState().page).toBe("bench");
});

it("says why an experiment did not open", async () => {
  server.on("POST", "/benches", new Refusal(409, "There is no free bench."));
  const { user, entry } = await mountGallery();
  await user.click(entry(first.id).getByRole("button", { name: /live$/ }));
  expect(await screen.findByText("There is no free bench.")).toBeVisible();
  expect(entry(first.id).getByRole("button", { name: /live$/ })).toBeEnabled();
});

it("offers the report and the figure of what has been measured", async () => {
  const { entry } = await mountGallery();
  expect(entry(first.id).getByRole("link", { name: /^Report of/ })).toHaveAttribute(
    "href",
    "./api/v1/runs/run-1/report",
  );
  expect(entry(first.id).getByRole("img")).toHaveAttribute("src", "./api/v1/runs/run-1/thumbnail");
  expect(entry(first.id).queryByRole("button", { name: /headless$/ })).not.toBeInTheDocument();
});

it("searches, filters by verdict and chapter, and shows all again", async () => {
  const { user, entries } = await mountGallery();
  await user.selectOptions(screen.getByRole("combobox", { name: "Verdict" }), "partly");
  expect(entries()).toEqual(library.filter(({ verdict }) => verdict === "partly").map(({ id }) => id));
  expect(screen.getByText(/^\d of 6$/)).toBeVisible();
  await user.type(screen.getByRole("searchbox"), "no such thing");
  expect(screen.getByText("No experiment matches")).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Show all" }));
  expect(screen.getByRole("list", { name: "Experiments" }).children).toHaveLength(library.length);
});

it("shows the experiment that the address names alone, names the window after it, and copies its link", async () => {
  const { user, entries, entry } = await mountGallery();
  expect(document.title).toBe("Gallery | CombBench");
  await user.click(entry(study.id).getByRole("link", { name: micro(study.title) }));
  expect(window.location.pathname).toBe(`/gallery/${study.id}`);
  expect(entries()).toEqual([study.id]);
  expect(document.title).toBe(`${micro(study.title)} | Gallery | CombBench`);
  await user.click(screen.getByRole("button", { name: "Copy link" }));
  expect(await screen.findByRole("button", { name: "Link copied" })).toBeVisible();
  expect(await navigator.clipboard.readText()).toBe(`http://localhost:3000/gallery/${study.id}`);
  await user.click(screen.getByRole("button", { name: "All experiments" }));
  expect(entries()).toEqual(library.map(({ id }) => id));
  expect(screen.getByRole("button", { name: "Copy link" })).toBeVisible();
});

it("says that the library does not have the experiment of an address", async () => {
  openPlace("gallery", "none");
  const { user } = mount(<GalleryPage />);
  expect(await screen.findByText("The library has no experiment none")).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Show all" }));
  expect(screen.getByRole("list", { name: "Experiments" }).children).toHaveLength(library.length);
});

it("says how many figures have been made, and what is wrong with them", async () => {
  server.on("GET", "/gallery", {
    cards,
    figures: { made: 3, total: 6, is_making: true, problem: "The disk is full." },
  });
  const { entry } = await mountGallery();
  expect(screen.getByText("Figures: 3 of 6")).toBeVisible();
  expect(screen.getByRole("progressbar", { name: "Figures that have been made" })).toHaveAttribute(
    "aria-valuenow",
    "50",
  );
  expect(screen.getByText("The disk is full.")).toBeVisible();
  expect(entry(study.id).getByText("Its figure is being made")).toBeVisible();
});

it("gives a student no run, no report and no lecture, and a watcher no bench either", async () => {
  be("student");
  const { unmount } = await mountGallery();
  expect(screen.queryByRole("button", { name: /headless$/ })).not.toBeInTheDocument();
  expect(screen.queryByRole("link", { name: /^Report/ })).not.toBeInTheDocument();
  expect(screen.queryByText(/lectures/)).not.toBeInTheDocument();
  expect(screen.getAllByRole("button", { name: /live$/ }).length).toBeGreaterThan(0);
  unmount();
  be("watcher");
  await mountGallery();
  expect(screen.queryByRole("button", { name: /headless$|live$|disk|Mine/ })).not.toBeInTheDocument();
});

it("lists the lectures, and starts one", async () => {
  server.on("GET", "/lectures/:id", new Refusal(404, "There is no such lecture."));
  const { user } = await mountGallery();
  const list = await screen.findByRole("list", { name: "Lectures" });
  expect(
    within(list)
      .getAllByRole("heading", { hidden: true })
      .map((one) => one.textContent),
  ).toEqual(lectures.map(({ title }) => title));
  await user.click(within(list).getByRole("button", { name: `Start ${lectures[1].title}`, hidden: true }));
  expect(server.asked("GET", `/lectures/${lectures[1].id}`)).toHaveLength(1);
  expect(await screen.findByText("There is no such lecture.")).toBeVisible();
});

it("says that the gallery did not come, and asks again", async () => {
  server.on("GET", "/gallery", new Refusal(503, "The service is busy."));
  const { user } = mount(<GalleryPage />);
  expect(await screen.findByText(/The service is busy/)).toBeVisible();
  server.on("GET", "/gallery", { cards, figures: { ...figures, is_making: false } });
  await user.click(screen.getByRole("button", { name: /again/i }));
  expect(await screen.findByRole("list", { name: "Experiments" })).toBeVisible();
});
