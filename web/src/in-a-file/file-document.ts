import type { LogEntry, PrintedMark } from "../api/types";

/** How the numbers at some places follow a value: as its multiples, or by the points of a grid. */
export interface Dependence {
  places: BigInt64Array;
  factors?: Float64Array;
  grid?: number[];
  /** For each point of the grid the numbers of all places. */
  numbers?: Float64Array;
}

interface FaultVariant {
  parameters: { profile: { kind: string }; parameters: Record<string, unknown> };
  dependence: Dependence;
  /** The packed numbers of the suggested severity, from tick 0 on. */
  packed: Float64Array;
}

export interface FileFault {
  row: number;
  title: string;
  group: string;
  /** The part of the device that it is seen on. */
  shows: string | null;
  unit: string;
  suggested: number;
  minimum: number | null;
  maximum: number | null;
  low: number;
  high: number;
  /** Among its numbers the tick at which it begins; -1 for none. */
  start: number;
  absent: Float64Array;
  variants: FaultVariant[];
}

export interface FileValue {
  label: string;
  unit: string;
  value: number;
  low: number;
  high: number;
  dependence: Dependence;
}

interface WiringWrites<Numbers> {
  places: BigInt64Array;
  numbers: Record<string, Numbers>;
}

export type FileCommand =
  | { fault: string; severity: number; variant?: number }
  | { heal: string[] | "all" }
  | { switch: string; cold?: boolean }
  | { set: Record<string, number> }
  | { reset_trip: true };

export interface FileEvent {
  /** The tick it waits for, or from which on its condition is watched; none for a condition from the start. */
  tick: number | null;
  command: FileCommand;
  /** The place of a signal, 1 for above or -1 for below, and the threshold. */
  when?: [number, number, number];
  /** Whose command it is, if it is not of the scenario. */
  actor?: string;
}

export interface Told {
  kind: string;
  diagnoser?: string;
  words?: string[];
  text?: string;
  left?: number[];
  columns?: number[];
}

interface FileRow {
  key: string;
  prefix: string;
  p: [number, number];
  s: [number, number];
  /** The places of its signals. */
  w: number[];
}

export interface FileDiagnoser {
  kind: string;
  title: string;
  scored: boolean;
  names: string[];
  factors: Record<string, number>[];
}

/** Where the counters of a score are. */
export interface FileScore {
  row: number;
  names: string[];
  places: Record<string, number>;
  /** How many numbers the lists among them have. */
  kept: Record<string, number>;
  winner: number;
  unexplained: number;
}

/** The acts of a supervisor by the number of its request, the place of this number, and the values that they set. */
export interface FileSupervisor {
  place: number;
  values: Record<string, unknown>;
  places: BigInt64Array;
  requests: { act: FileAct; numbers?: Float64Array }[][];
}

export type FileAct = { switch: string; cold?: boolean } | { set: Record<string, unknown> } | { make_safe: string };

export interface FileSignal {
  name: string;
  unit: string;
  meaning: string;
}

/** All that a board in a file knows besides its code. */
export interface BoardDocument {
  dt_ms: number;
  arrays: { table: BigInt64Array; p: Float64Array; s: Float64Array; w: Float64Array; io: BigInt64Array };
  running: number[];
  /** Rows that run as one function where they run one after another, and its number. */
  segments: { rows: number[]; step: number }[];
  rows: FileRow[];
  endless: BigInt64Array;
  folds: BigUint64Array;
  fold: BigUint64Array;
  history: {
    lanes: number;
    widest: number;
    capacity: number;
    offsets: BigInt64Array;
    sizes: BigInt64Array;
    groups: BigInt64Array;
    places: BigInt64Array;
    ring: [number, number];
    buckets: [number, number];
  };
  look_every: number;
  reasons: { tripped: number; watched: number; changed: number };
  outputs: number;
  reserved: number;
  signals: FileSignal[];
  blocks: string[];
  trip: number;
  guards: number[];
  trip_reasons: Record<string, string>;
  disengaged: number[];
  followed: { columns: BigInt64Array; last: Float64Array; told: Told[] };
  diagnosers: Record<string, FileDiagnoser>;
  scores: Record<string, FileScore>;
  faults: Record<string, FileFault>;
  /** The faults that act from the first tick on. */
  present: Record<string, { severity: number; variant: number; since: number }>;
  wirings: {
    slots: Record<string, string>;
    driving: Record<string, string>;
    writes: { p: WiringWrites<Float64Array>; io: WiringWrites<BigInt64Array>; w: WiringWrites<Float64Array> };
  };
  values: Record<string, FileValue>;
  supervisor: FileSupervisor | null;
  sensors: { all: string[]; measuring: string };
  controllers: Record<string, string>;
  /** The entries of the log before the first tick. */
  log: Omit<FileEntry, "seq">[];
}

/** A twin: the columns that are seen, and the controllers and values that commands to the bench do not reach. */
export interface TwinDocument extends BoardDocument {
  shown: number[];
  own_switches: string[];
  own_values: string[];
}

/** All that a bench in a file knows besides its code. */
export interface FileDocument extends BoardDocument {
  id: string;
  title: string;
  summary: string;
  absent: string;
  version: string;
  seed: number;
  /** The numbers of the drawing of the device, or of the device drawn in its place; none for a gyroscope. */
  plan: { geometry: Record<string, number> | null; is_stand_in: boolean };
  events: FileEvent[];
  /** Commands that have taken effect before the first tick, which the twins carry out at it. */
  done: [number, FileCommand][];
  twins: Record<string, TwinDocument>;
  /** The run whose figures and digest are published. */
  published?: FilePublished;
  /** The address of the list of pages that this page is one of. */
  index?: string;
  sheet?: FileSheet;
}

export interface FilePublished {
  source: string;
  claim: string;
  verdict: string;
  ticks: number;
  digest: string;
  expectations: { metric: string; published: string; expected: string; measured: string; ok: boolean }[];
  marks: PrintedMark[];
}

export interface FileQuestion {
  heading: string;
  text: string;
  question: string;
  points: number;
  tries: number;
  value: number;
  unit: string;
  within: number;
  within_absolute: number;
  partly: { within: number; share: number } | null;
}

/** The questions of a lab sheet that a file can judge, and a line about the other steps. */
export interface FileSheet {
  title: string;
  intro: string;
  questions: FileQuestion[];
  rest: string;
}

export type FileEntry = Pick<LogEntry, "seq" | "tick" | "actor" | "kind" | "text" | "old" | "new"> & {
  command?: FileCommand;
};
