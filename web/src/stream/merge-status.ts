import type { Bench } from "../api/types";

type BenchChanges = { [K in keyof Bench]?: Bench[K] | null };

/** The bench with what a status says changed; unchanged parts keep their identity so little re-renders. */
export function mergeStatus(bench: Bench, status: BenchChanges): Bench {
  const merged: Record<string, unknown> = { ...bench };
  let changed = false;
  for (const [key, value] of Object.entries(status)) {
    if (!(key in bench) && key !== "trip") continue;
    if (key === "parameters" && value === null) continue; // the server's word for "as before"
    const before = merged[key];
    if (before === value || (isObject(value) && JSON.stringify(before) === JSON.stringify(value))) continue;
    merged[key] = value;
    changed = true;
  }
  return changed ? (merged as unknown as Bench) : bench;
}

function isObject(value: unknown): boolean {
  return typeof value === "object" && value !== null;
}
