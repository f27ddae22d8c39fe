import { expect, it } from "vitest";
import { panelOf } from "./panel-views";

const texts = (files: Record<string, unknown>) => Object.entries(files as Record<string, string>);
const lectures = texts(
  import.meta.glob("../../../scenarios/lectures/*.toml", { query: "?raw", import: "default", eager: true }),
);
const page = texts(
  import.meta.glob(["../**/*.{ts,tsx}", "!../**/*.test.{ts,tsx}"], { query: "?raw", import: "default", eager: true }),
);

/** Names of views in texts, by the texts that say them. */
const named = (texts: [string, string][], saying: RegExp, inside = /"(\w+)"/g) =>
  texts.flatMap(([file, text]) =>
    [...text.matchAll(saying)].flatMap(([said]) => [...said.matchAll(inside)].map(([, name]) => ({ file, name }))),
  );

it("knows every view that a lecture brings to the front", () => {
  const found = named(lectures, /^panels = \[.*\]$/gm);
  expect(found.length).toBeGreaterThan(30);
  expect(found.filter(({ name }) => !panelOf(name))).toEqual([]);
});

it("knows every view that the page and its tours bring to the front or point at", () => {
  const found = named(page, /\b(?:showPanel|showBeside|showAtEdge|addPanel|panelWith|panel|show)\((?:"\w+"(?:, )?)+/g);
  expect(found.length).toBeGreaterThan(40);
  expect(found.filter(({ name }) => !panelOf(name))).toEqual([]);
});
