import { expect, it } from "vitest";
import { linesOf } from "./lines-of";

const pen = { measureText: (text: string) => ({ width: 10 * text.length }) };

it.each([
  [1000, ["the bench has dropped it"]],
  [100, ["the bench", "has", "dropped it"]],
  [30, ["the", "bench", "has", "dropped", "it"]],
])("breaks a text into the lines that fit %s px", (width, lines) => {
  expect(linesOf(pen, "the bench has dropped it", width)).toEqual(lines);
});
