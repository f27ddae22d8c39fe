import { expect, it } from "vitest";
import type { BlockCard } from "../api/types";
import { sourceOnBench, valuesOf } from "./unit-values";

const card = (family: string): BlockCard => ({ family, name: "mine" }) as BlockCard;

it("brings a controller, and lets it drive if it should", () => {
  expect(valuesOf(card("control"), "text", false)).toEqual({ "units.mine.source": "text" });
  expect(valuesOf(card("control"), "text", true)).toEqual({
    "units.mine.source": "text",
    "controller.kind": "mine",
  });
});

it("names a diagnoser and an identifier, unless the bench does", () => {
  expect(valuesOf(card("diagnose"), "text", false)).toEqual({
    "units.mine.source": "text",
    "diagnosers.mine": { kind: "mine" },
  });
  expect(valuesOf(card("identify"), "text", false)).toHaveProperty(["identifiers.mine"], { kind: "mine" });
  const there = { diagnosers: { mine: { kind: "mine", memory: 0.9 } } };
  expect(valuesOf(card("diagnose"), "text", false, there)).toEqual({ "units.mine.source": "text" });
});

it("knows the text on the bench", () => {
  expect(sourceOnBench({ units: { mine: { source: "text" } } }, "mine")).toBe("text");
  expect(sourceOnBench({}, "mine")).toBeUndefined();
});
