import { expect, test } from "vitest";
import type { BlockCard, Equation } from "../api/types";
import { entriesOf, found } from "./equations";

const equation = (label: string, more: Partial<Equation> = {}): Equation => ({
  label,
  latex: "x=1",
  source: "",
  printed: "",
  why: "",
  ...more,
});
const block = (family: string, name: string, equations: Equation[]) =>
  ({ family, name, title: name, equations }) as unknown as BlockCard;

const ENTRIES = entriesOf([
  block("control", "mrac", [
    equation("augmented_error", { source: "3.3.2" }),
    equation("law", { source: "3.3.4", printed: "x=2", why: "the sign of the gain" }),
  ]),
  block("plant", "linear", [equation("motion", { source: "1.2", latex: String.raw`m\ddot x` })]),
]);
const labels = (asked: string, errataOnly = false) =>
  found(ENTRIES, asked, errataOnly).map(({ name, entries }) => [name, ...entries.map((e) => e.equation.label)]);

test("all equations are there, by family", () => {
  expect(labels("")).toEqual([
    ["control", "augmented_error", "law"],
    ["plant", "motion"],
  ]);
});

test("an equation is found by its label, its section, its block, its letters, and what was wrong with it", () => {
  expect(labels("augmented ERROR")).toEqual([["control", "augmented_error"]]);
  expect(labels("3.3.4")).toEqual([["control", "law"]]);
  expect(labels("linear")).toEqual([["plant", "motion"]]);
  expect(labels("ddot")).toEqual([["plant", "motion"]]);
  expect(labels("mrac sign")).toEqual([["control", "law"]]);
  expect(labels("mrac motion")).toEqual([]);
});

test("what several blocks of a family share stands once, with all their names", () => {
  const shared = equation("motion");
  const entries = entriesOf([
    block("plant", "a", [shared]),
    block("plant", "b", [shared]),
    block("sense", "c", [shared]),
  ]);
  expect(entries.map((entry) => entry.blocks)).toEqual([["a", "b"], ["c"]]);
  expect(found(entries, "b motion", false)).toHaveLength(1);
});

test("errata alone are those that were printed otherwise", () => {
  expect(labels("", true)).toEqual([["control", "law"]]);
  expect(labels("motion", true)).toEqual([]);
});
