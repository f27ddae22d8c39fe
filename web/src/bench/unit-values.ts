import type { BlockCard, Document } from "../api/types";

/** The text of a unit on the bench; undefined without one. */
export const sourceOnBench = (parameters: Document | undefined, name: string): string | undefined =>
  (parameters?.units as Record<string, { source: string }> | undefined)?.[name]?.source;

/** Tables that must name a unit of a family to put it on a bench; units of other families need no entry. */
const NAMED: Record<string, string> = { diagnose: "diagnosers", identify: "identifiers" };

/** Values over a scenario that add a unit to it; a controller may drive from the first tick. */
export function valuesOf(card: BlockCard, source: string, drives: boolean, parameters?: Document): Document {
  const table = NAMED[card.family];
  const there = table && (parameters?.[table] as Document | undefined)?.[card.name];
  return {
    [`units.${card.name}.source`]: source,
    ...(table && !there ? { [`${table}.${card.name}`]: { kind: card.name } } : {}),
    ...(drives ? { "controller.kind": card.name } : {}),
  };
}
