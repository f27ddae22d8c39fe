import type { FileCommand, FileDocument } from "./file-document";

/** A fault of a case: its row, the tick's place among its numbers, and its numbers when absent and when it acts. */
interface CaseFault {
  name: string;
  row: number;
  start: number;
  absent: Float64Array;
  packed: Float64Array;
}

/** The places at which the cases of a group differ, and for each place the row of its numbers. */
interface Differences {
  places: BigInt64Array;
  which: BigInt64Array;
}

export interface TrackCase {
  group: number;
  seed: string;
  samples: number;
  faults: CaseFault[];
  events: { tick: number; command: Extract<FileCommand, { fault: string }> }[];
}

/** Cases of one kind of board. */
interface TrackGroup {
  document: FileDocument;
  /** The signals of each diagnoser that its digest is of. */
  said: Record<string, number[]>;
  differs: Record<"p" | "s" | "w", Differences>;
  /** Of each number its values in all cases of the group. */
  numbers: Float64Array;
}

export interface TrackRow {
  unit: string;
  title: string;
  log_score: number | null;
  digest: string;
}

/** A track of the benchmark: its cases, and the published row of each diagnoser. */
export interface TrackDocument {
  title: string;
  summary: string;
  version: string;
  index?: string;
  track: { note: string; samples: number; groups: TrackGroup[]; cases: TrackCase[]; rows: TrackRow[] };
}

/** Write the numbers, faults and events of a case into the document of its group, which its bench begins with. */
export function writeCase({ groups, cases }: TrackDocument["track"], number: number): FileDocument {
  const { group, faults, events } = cases[number];
  const { document, differs, numbers } = groups[group];
  const count = cases.filter((one) => one.group === group).length;
  const own = cases.slice(0, number).filter((one) => one.group === group).length;
  for (const name of ["p", "s", "w"] as const) {
    const { places, which } = differs[name];
    for (const [i, place] of places.entries())
      document.arrays[name][Number(place)] = numbers[count * Number(which[i]) + own];
  }
  const severities = Object.fromEntries(events.map(({ command }) => [command.fault, command.severity]));
  const entries = faults.map(({ name, ...fault }) => [
    name,
    { ...fault, variants: [variant(fault, severities[name])] },
  ]);
  document.faults = Object.fromEntries(entries) as unknown as FileDocument["faults"];
  document.events = events;
  return document;
}

/** A fault with one severity alone. */
const variant = ({ packed }: Pick<CaseFault, "packed">, severity: number) => ({
  parameters: { profile: { kind: "step" }, parameters: {} },
  packed,
  dependence: { places: new BigInt64Array(), grid: [severity], numbers: new Float64Array() },
});
