import type { Text } from "@codemirror/state";
import type { UnitMistake } from "../../api/types";

/** The place of a mistake in a text: the name there with its fields, or the sign. */
export function spanOf(
  doc: Text,
  { line, column }: Pick<UnitMistake, "line" | "column">,
): { from: number; to: number } {
  const { from, to, text } = doc.line(Math.min(Math.max(line, 1), doc.lines));
  const at = Math.min(column - 1, Math.max(text.length - 1, 0));
  const word = /^[\w.]+/.exec(text.slice(at))?.[0].length ?? 1;
  return { from: from + at, to: Math.min(from + at + word, to) };
}
