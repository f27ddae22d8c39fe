import { create } from "zustand";
import type { Bench, LogEntry, Score } from "../api/types";
import type { CloseReason } from "./close-reason";
import { type Narration, NOTHING_SAID } from "./narration";

type Phase = "idle" | "connecting" | "open" | "waiting" | "closed";

export interface Connection {
  phase: Phase;
  reason: CloseReason | undefined;
  /** Next attempt, on `performance.now()`'s clock. */
  retryAt: number | undefined;
  /** Wall time since when nothing has arrived; undefined while the page is current. Read it by `freshness`. */
  staleSince: Date | undefined;
}

export interface BenchStore {
  connection: Connection;
  bench: Bench | undefined;
  scores: Record<string, Score>;
  events: LogEntry[];
  /** The sentences of the narrator about the present run. */
  narration: Narration;
  /** A hidden fault is to be found: the server serves little else, and panels that need more show one line. */
  blind: boolean;
  /** How often the server has refused a bench behind the traces because it is gone. */
  behindRefused: number;
  droppedFrames: number;
  /** The latest word of the server about this connection. */
  notice: { code: string; message: string } | undefined;
  /** How often the server has called the page to ask for its rights again. */
  called: number;
}

/** The state of the bench on the page. Written only by the stream; frames never pass through here. */
export const useBench = create<BenchStore>(() => ({
  connection: { phase: "idle", reason: undefined, retryAt: undefined, staleSince: undefined },
  bench: undefined,
  scores: {},
  events: [],
  narration: NOTHING_SAID,
  blind: false,
  behindRefused: 0,
  droppedFrames: 0,
  notice: undefined,
  called: 0,
}));

type BenchChanges = { [K in keyof Bench]?: Bench[K] | null };

/** The bench with the changes of a status; unchanged parts keep their identity so little re-renders. */
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
