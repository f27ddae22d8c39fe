import { Text } from "@codemirror/state";
import { expect, it } from "vitest";
import { spanOf } from "./span";

const doc = Text.of(["import os", "    e = x.model - x.truth", "", "y = ("]);
const textAt = (line: number, column: number) => {
  const { from, to } = spanOf(doc, { line, column });
  return doc.sliceString(from, to);
};

it("underlines a name with its fields", () => {
  expect(textAt(1, 1)).toBe("import");
  expect(textAt(2, 19)).toBe("x.truth");
});

it("underlines a sign, and nothing where there is nothing", () => {
  expect(textAt(4, 5)).toBe("(");
  expect(textAt(3, 1)).toBe("");
});

it("stays within a text that has become shorter", () => {
  expect(textAt(4, 99)).toBe("(");
  expect(textAt(99, 1)).toBe("y");
});
