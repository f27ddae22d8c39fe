import type { Bench, Signal } from "../api/types";
import type { Subscription } from "../stream/wire";

const UNITS = { displacement: "um", displacement_std: "um", velocity: "um/ms", velocity_std: "um/ms" };
const RATIOS = { mass: "1", stiffness: "1", damping: "1" };

/** A bench with the signals of the weighted estimate of its bank. */
export function withWeighted(bench: Bench): Bench {
  const rest = bench.signals.filter(({ name }) => !name.includes(".weighted."));
  const own = Object.entries({ ...UNITS, ...RATIOS }).map(([port, unit], i): Signal => {
    const place = { block: "kalman.weighted", kind: "tap" as const, index: rest.length + i };
    return { name: `kalman.weighted.${port}`, unit, meaning: port, ...place };
  });
  return { ...bench, signals: [...rest, ...own] };
}

/** The subscriptions of a panel except for the words of a weighted estimate. */
export const besideEstimate = (subscriptions: readonly Subscription[]): Subscription[] =>
  subscriptions.filter(({ signals }) => !signals.some((name) => name.includes(".weighted.")));
