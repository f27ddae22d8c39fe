import { expect, it } from "vitest";
import { type Entry, find } from "./find";

const entry = (group: Entry["group"], title: string, about = "", words = ""): Entry => ({
  group,
  key: `${group} ${title}`,
  title,
  about,
  words,
  open: () => undefined,
});

const ENTRIES = [
  entry("Equations", "MRAC adaptive law", "5.2.3.2", "kx gamma"),
  entry("Settings", "Gain", "MRAC"),
  entry("Scenarios", "Seven steps", "ch5-seven-step", "bank"),
  entry("Panels", "Controller", "Choose a controller, tune it"),
  entry("Places", "Runs", "Headless runs and campaigns"),
  entry("Panels", "Scope", "Signals over time"),
];

const titles = (asked: string) =>
  find(ENTRIES, asked).map(([group, found]) => [group, ...found.map(({ title }) => title)]);

it("without words, places and panels are there", () => {
  expect(titles(" ")).toEqual([
    ["Places", "Runs"],
    ["Panels", "Controller", "Scope"],
  ]);
});

it("an entry is found by all words of its title, its line and its further words, in any case and order", () => {
  expect(titles("STEP seven")).toEqual([["Scenarios", "Seven steps"]]);
  expect(titles("5.2.3.2")).toEqual([["Equations", "MRAC adaptive law"]]);
  expect(titles("mrac")).toEqual([
    ["Settings", "Gain"],
    ["Equations", "MRAC adaptive law"],
  ]);
  expect(titles("mrac seven")).toEqual([]);
});

it("entries with the words in their titles come first, and no more than six of a group", () => {
  const many = [
    entry("Panels", "Loop", "scope of it"),
    ...[1, 2, 3, 4, 5, 6].map((n) => entry("Panels", `Scope ${n}`)),
  ];
  expect(find(many, "scope")[0][1].map(({ title }) => title)).toEqual([1, 2, 3, 4, 5, 6].map((n) => `Scope ${n}`));
  expect(find(many.slice(0, 3), "scope")[0][1].map(({ title }) => title)).toEqual(["Scope 1", "Scope 2", "Loop"]);
});
