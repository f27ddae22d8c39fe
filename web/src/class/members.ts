import type { Outcomes, Tile, Verdict } from "../api/types";
import { formatNumber } from "../ui/format";

export const ORDERS = { name: "by name", hand: "hands first", tripped: "tripped first" } as const;
export type Order = keyof typeof ORDERS;

const isFirst: Record<Order, (tile: Tile) => boolean> = {
  name: () => false,
  hand: (tile) => tile.hand,
  tripped: (tile) => tile.state === "tripped",
};

const byName = (a: string, b: string) => a.localeCompare(b, undefined, { numeric: true });

/** The students whose name has the words, in an order; among equals by name. */
export function arranged(tiles: readonly Tile[], order: Order, words: string): Tile[] {
  const first = isFirst[order];
  const wanted = words.trim().toLowerCase();
  return tiles
    .filter((tile) => tile.name.toLowerCase().includes(wanted))
    .sort((a, b) => Number(first(b)) - Number(first(a)) || byName(a.name, b.name));
}

/** Whether a diagnoser is right; undefined while it has no verdict but should have one. */
export function isRight({ says, truth }: Verdict): boolean | undefined {
  if (says === truth) return true;
  return says === null ? undefined : false;
}

const MOST_NAMED = 3;

/** What became of something done on many benches, in one line. */
export function outcomeLine(what: string, { done, failed }: Outcomes): string {
  if (failed.length === 0) return `${what}: ${formatNumber(done, 0)} done.`;
  const named = failed.slice(0, MOST_NAMED).join("; ");
  const rest = failed.length - MOST_NAMED;
  const more = rest > 0 ? `; and ${formatNumber(rest, 0)} more` : "";
  return `${what}: ${formatNumber(done, 0)} done, ${formatNumber(failed.length, 0)} refused: ${named}${more}.`;
}

/** The outline of a small trace in a box of `columns - 1` by 2, zero in the middle; its reach in the unit of the trace. */
export function outline(trace: readonly (readonly [number, number])[], least: number): { path: string; reach: number } {
  const reach = Math.max(least, ...trace.flat().map(Math.abs));
  const at = (x: number, y: number) => `${x} ${Math.round(1000 * (1 - y / reach)) / 1000}`;
  const top = trace.map(([, high], x) => at(x, high));
  const bottom = trace.map(([low], x) => at(x, low)).reverse();
  return { path: trace.length > 0 ? `M${[...top, ...bottom].join("L")}Z` : "", reach };
}
