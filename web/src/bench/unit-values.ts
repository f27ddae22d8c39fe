import type { BlockCard, Document } from "../api/types";

/** The text of a unit on the bench, if it is there. */
export const sourceOnBench = (parameters: Document | undefined, name: string): string | undefined =>
  (parameters?.units as Record<string, { source: string }> | undefined)?.[name]?.source;

/** Tables in which a unit of a family must be named to be on a bench; the others are there by themselves. */
const NAMED: Record<string, string> = { diagnose: "diagnosers", identify: "identifiers" };

/** Values over a scenario that bring a unit into it; one that controls may drive from the first tick. */
export function valuesOf(card: BlockCard, source: string, drives: boolean, parameters?: Document): Document {
  const table = NAMED[card.family];
  const there = table && (parameters?.[table] as Document | undefined)?.[card.name];
  return {
    [`units.${card.name}.source`]: source,
    ...(table && !there ? { [`${table}.${card.name}`]: { kind: card.name } } : {}),
    ...(drives ? { "controller.kind": card.name } : {}),
  };
}
