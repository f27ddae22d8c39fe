import { create } from "zustand";
import { api } from "../api/api";
import type { Bench, LogEntry } from "../api/types";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/event-log";
import { alarm } from "./announce";
import { showError, showing } from "./send";

/** As many as the server sends. */
export const MOST_BEHIND = 8;

/** A bench whose traces are drawn behind the traces of the bench on the page. */
export interface Behind {
  bench: string;
  words: string;
  /** Its tick minus the tick of the bench on the page. */
  shift: number;
}

/** The common point of the traces: the same time, or the last event of a kind on each bench. */
export type Alignment = "time" | "inject" | "heal" | "switch" | "tripped";

interface BehindStore {
  behind: Behind[];
  alignment: Alignment;
  /** Whether the difference from the first is shaded, and drawn on an axis of its own. */
  shaded: boolean;
  difference: boolean;
}

export const useBehind = create<BehindStore>(() => ({
  behind: [],
  alignment: "time",
  shaded: true,
  difference: false,
}));

/** The name of a bench in a list. */
export const wordsOf = (bench: Pick<Bench, "title" | "name" | "origin" | "dt_ms">): string => bench.name || bench.title;

/** The benches behind the traces, in words. */
export function behindText(behind: readonly Behind[], difference: boolean): string {
  const names = behind.map(({ words }) => words).join("; ");
  const dotted = `Dotted, on the axis Δ: the difference from ${behind[0]?.words}, where the window shows each sample.`;
  return `Behind, faded: ${names}.${difference ? ` ${dotted}` : ""}`;
}

const rateHere = () => useBench.getState().bench?.sample_rate_khz;

/** Put a bench behind the one on the page, if it has the same sample rate. */
export const addBehind = showing(async (id: string) => {
  const { behind, alignment } = useBehind.getState();
  if (behind.some((one) => one.bench === id) || behind.length >= MOST_BEHIND) return;
  const rate = rateHere(); // while the answer is awaited the page may connect anew, and know no bench
  const bench = await api.bench(id);
  if (bench.sample_rate_khz !== rate) {
    alarm(
      `${wordsOf(bench)} runs at ${bench.sample_rate_khz} kHz and this bench at ${rate} kHz: it cannot lie behind.`,
    );
    return;
  }
  const shift = (await shiftOf(id, alignment)) ?? 0;
  useBehind.setState(({ behind }) => ({
    behind: [...behind.filter((one) => one.bench !== id), { bench: id, words: wordsOf(bench), shift }],
  }));
});

/** Call a bench behind the traces something else. */
export function renameBehind(id: string, words: string): void {
  useBehind.setState(({ behind }) => ({
    behind: behind.map((one) => (one.bench === id ? { ...one, words } : one)),
  }));
}

export function removeBehind(id: string): void {
  useBehind.setState(({ behind }) => ({ behind: behind.filter((one) => one.bench !== id) }));
}

/** Align all benches behind at their last events of a kind; those without such an event stay at the same time. */
export const align = showing(async (alignment: Alignment) => {
  const shifts = await Promise.all(
    useBehind.getState().behind.map(async ({ bench }) => [bench, (await shiftOf(bench, alignment)) ?? 0] as const),
  );
  const by = new Map(shifts);
  useBehind.setState(({ behind }) => ({
    alignment,
    behind: behind.map((one) => ({ ...one, shift: by.get(one.bench) ?? one.shift })),
  }));
});

/** Forget benches that are gone, or that have another rate than the bench on the page: the server draws nothing of them. */
async function forgetGone(): Promise<void> {
  const rate = rateHere();
  if (rate === undefined || useBehind.getState().behind.length === 0) return;
  const there = new Set((await api.benches()).flatMap((one) => (one.sample_rate_khz === rate ? [one.id] : [])));
  useBehind.setState(({ behind }) => ({ behind: behind.filter((one) => there.has(one.bench)) }));
}

/** How much later than here the last event of a kind is on another bench; nothing where one of them has none. */
async function shiftOf(id: string, alignment: Alignment): Promise<number | undefined> {
  if (alignment === "time") return 0;
  const here = lastOf(useBench.getState().events, alignment);
  const there = lastOf((await api.events(id)).events, alignment);
  return here === undefined || there === undefined ? undefined : there - here;
}

const lastOf = (events: readonly LogEntry[], kind: Alignment): number | undefined =>
  currentEvents([...events]).findLast((event) => event.kind === kind)?.tick;

/** The benches behind the traces of another bench that the page shows now. */
export function behindOf(
  behind: readonly Behind[],
  before: Pick<Bench, "id" | "title" | "name" | "origin" | "dt_ms"> | undefined,
  now: Pick<Bench, "id" | "origin" | "dt_ms">,
): Behind[] {
  const known = behind.find((one) => one.bench === now.id);
  if (before && before.dt_ms === now.dt_ms && known) {
    const shift = known.shift;
    return behind.map((one) =>
      one === known
        ? { bench: before.id, words: wordsOf(before), shift: -shift }
        : { ...one, shift: one.shift - shift },
    );
  }
  const isRelated = now.origin?.bench === before?.id || before?.origin?.bench === now.id;
  return isRelated ? [...behind] : [];
}

let last: Bench | undefined;

useBench.subscribe(({ behindRefused }, before) => {
  if (behindRefused !== before.behindRefused) forgetGone().catch(showError);
});

// benches that are aligned at the last event of the bench on the page follow it
useBench.subscribe(({ events }, before) => {
  const { alignment, behind } = useBehind.getState();
  if (alignment === "time" || behind.length === 0 || events === before.events) return;
  if (lastOf(events, alignment) !== lastOf(before.events, alignment)) void align(alignment);
});

useBench.subscribe(({ bench }) => {
  if (!bench || (last?.id === bench.id && last.origin?.is_past === bench.origin?.is_past)) {
    last = bench ?? last;
    return;
  }
  const before = last;
  last = bench;
  if (before?.id !== bench.id) useBehind.setState(({ behind }) => ({ behind: behindOf(behind, before, bench) }));
  // a branch is compared with its origin, unless the origin is gone
  const { origin } = bench;
  if (origin && !origin.is_past)
    void api
      .benches()
      .then((all) => (all.some(({ id }) => id === origin.bench) ? addBehind(origin.bench) : undefined))
      .catch(showError);
});
