import type { TruthSwitch } from "./delays";

/** Who found the latest change of the truth first: places by delay, equal delays share one; the rest have none. */
export function racePlaces(switches: Record<string, TruthSwitch[]>): Record<string, number> {
  const latest = Math.max(...Object.values(switches).map((list) => list.at(-1)?.tick ?? -1));
  const found = Object.entries(switches).flatMap(([id, list]) => {
    const last = list.at(-1);
    return last && last.tick === latest && last.delay !== undefined ? [{ id, delay: last.delay }] : [];
  });
  return Object.fromEntries(found.map(({ id, delay }) => [id, 1 + found.filter((f) => f.delay < delay).length]));
}
