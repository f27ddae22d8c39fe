import { expect, it } from "vitest";
import type { GalleryCard } from "../api/types";
import { chapterOf, chaptersOf, chosen, EVERYTHING } from "./chapters";

const card = (id: string, rest: Partial<GalleryCard> = {}): GalleryCard => ({
  id,
  title: id,
  source: "",
  summary: "",
  claim: "",
  verdict: null,
  demo: false,
  topics: [],
  figure: null,
  problem: "",
  study: null,
  run: null,
  state: "new",
  progress: 0,
  elapsed_s: null,
  digest: "",
  ok: null,
  expectations: [],
  ...rest,
});

const CARDS = [
  card("appB-mit", { verdict: "reproduced", ok: true }),
  card("ch10-far", { verdict: "partly", ok: false }),
  card("ch5-seven-step", { title: "Seven-step scenario", verdict: "reproduced" }),
  card("first-look", { demo: true, topics: ["ch3", "Kalman bank (MMAE)", "Added mass"] }),
];

it("reads the chapter from the id", () => {
  expect(["ch5-seven-step", "appA-spr", "gyro-allan", "first-look"].map(chapterOf)).toEqual(["5", "A", "6", "live"]);
});

it("orders chapters as the book does, numbers by value, appendices last", () => {
  expect(chaptersOf(CARDS)).toEqual(["live", "5", "10", "B"]);
});

it("filters by chapter, verdict, and all words at once", () => {
  const ids = (filter: object) => chosen(CARDS, { ...EVERYTHING, ...filter }).map((c) => c.id);
  expect(ids({})).toEqual(["first-look", "ch5-seven-step", "ch10-far", "appB-mit"]);
  expect(ids({ chapter: "5" })).toEqual(["ch5-seven-step"]);
  expect(ids({ verdict: "reproduced" })).toEqual(["ch5-seven-step", "appB-mit"]);
  expect(ids({ verdict: "open" })).toEqual(["first-look", "ch5-seven-step", "ch10-far"]);
  expect(ids({ words: "step SEVEN" })).toEqual(["ch5-seven-step"]);
  expect(ids({ verdict: "reproduced", words: "step" })).toEqual(["ch5-seven-step"]);
});

it("finds by title, id, chapter, device, controller and fault, the best fit first", () => {
  const cards = [
    card("ch3-mrac-mass", { title: "Adaptive control", topics: ["lcr-350", "Direct MRAC", "Added mass"] }),
    card("ch5-closed-loop", { title: "Diagnosis in closed loop", summary: "under MRAC and PID", topics: ["PID"] }),
    card("gyro-first-look", { demo: true, title: "A gyroscope at work", topics: ["gyro-c"] }),
  ];
  const found = (words: string) => chosen(cards, { ...EVERYTHING, words }).map((one) => one.id);
  expect(found("")).toEqual(["gyro-first-look", "ch3-mrac-mass", "ch5-closed-loop"]);
  expect(found("mrac")).toEqual(["ch3-mrac-mass", "ch5-closed-loop"]);
  expect(found("lcr-350")).toEqual(["ch3-mrac-mass"]);
  expect(found("added mass")).toEqual(["ch3-mrac-mass"]);
  expect(found("chapter 5")).toEqual(["ch5-closed-loop"]);
  expect(found("gyroscope")).toEqual(["gyro-first-look"]);
  expect(found("pid diagnosis")).toEqual(["ch5-closed-loop"]);
  expect(found("nothing like that")).toEqual([]);
});
