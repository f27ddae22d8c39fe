import { formatShort } from "./format";

/** Lengths of device time that panels offer, ms. */
export const TIME_WINDOWS_MS = {
  scope: [0.2, 0.5, 1, 2, 4, 10, 20, 50, 100, 200, 500, 1000],
  lanes: [2, 4, 10, 20, 50, 100, 200, 500],
  phase: [1, 2, 4, 10, 20, 40],
} as const satisfies Record<string, readonly number[]>;

/** The items of a menu of lengths; one that is chosen but not usual stands among them. */
export function windowItems(usualMs: readonly number[], chosenMs: number): { value: string; label: string }[] {
  const all = usualMs.includes(chosenMs) ? usualMs : [...usualMs, chosenMs].sort((a, b) => a - b);
  return all.map((ms) => ({ value: String(ms), label: formatShort(ms, "ms") }));
}
