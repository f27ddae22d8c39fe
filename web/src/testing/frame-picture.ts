import type { Subscription } from "../stream/wire";

/** Values of signals by tick; a signal of a bench behind has the id of the bench and a slash before its name. */
export type Values = Record<string, (tick: number) => number>;

/** Where the board is, and what its trigger does. */
export interface FrameTime {
  /** The next tick; ticks before 0 and from this one on have no values. */
  head: number;
  triggerTick?: number;
  waiting?: boolean;
}

const TRIGGERED = 1;
const WAITING = 2;
const FROZEN = 4;

/** The picture that a server makes of a subscription: the least and largest value in each column of ticks. */
export function pictureOf(subscription: Subscription, values: Values, time: FrameTime, dtMs: number) {
  const { head, triggerTick, waiting = false } = time;
  const { startTick, endTick } = spanOf(subscription, time, dtMs);
  const columns = subscription.width;
  const first = (column: number) => startTick + Math.floor((column * (endTick - startTick)) / columns);
  const { signals, behind = [] } = subscription;
  const names = [...signals, ...behind.flatMap(({ bench }) => signals.map((signal) => `${bench}/${signal}`))];
  const rows = names.map((name) =>
    Array.from({ length: columns }, (_, column) => {
      const ticks = Array.from({ length: Math.max(1, first(column + 1) - first(column)) }, (_, i) => first(column) + i);
      const found = ticks.filter((tick) => tick >= 0 && tick < head).map((tick) => values[name]?.(tick) ?? Number.NaN);
      return found.length
        ? { low: Math.min(...found), high: Math.max(...found) }
        : { low: Number.NaN, high: Number.NaN };
    }),
  );
  return {
    startTick,
    endTick,
    triggerTick: triggerTick ?? Number.NaN,
    flags:
      (triggerTick === undefined ? 0 : TRIGGERED) +
      (waiting ? WAITING : 0) +
      (subscription.mode === "frozen" ? FROZEN : 0),
    min: rows.map((row) => row.map(({ low }) => low)),
    max: rows.map((row) => row.map(({ high }) => high)),
    latest: subscription.signals.map((name) => values[name]?.(head - 1) ?? Number.NaN),
  };
}

function spanOf(subscription: Subscription, { head, triggerTick }: FrameTime, dtMs: number) {
  if (subscription.mode === "frozen") return { startTick: subscription.start_tick, endTick: subscription.end_tick };
  const ticks = Math.round(subscription.window_ms / dtMs);
  const isTriggered = subscription.mode === "triggered" && triggerTick !== undefined;
  const startTick = isTriggered ? triggerTick - Math.round(subscription.trigger.position * ticks) : head - ticks;
  return { startTick, endTick: startTick + ticks };
}
