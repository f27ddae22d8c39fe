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
  card("first-look"),
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
