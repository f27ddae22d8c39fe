import type { Campaign } from "../api/types";
import { metricTitle } from "../ui/metric-name";
import { roundTo } from "../ui/unit-scale";

/** A value at a dotted path of the scenario, as typed; one value or several. */
export interface Row {
  path: string;
  text: string;
}

/** Bounds of a value at a dotted path, as typed. */
interface RangeRow {
  path: string;
  min: string;
  max: string;
  log: boolean;
}

/** The run or campaign in the form, before its start. */
export interface Draft {
  kind: "run" | "campaign";
  scenario: string;
  /** Name of the run or campaign; empty: its title. */
  label: string;
  set: Row[];
  /** Keep the signals of unused blocks too. */
  all: boolean;
  firstSeed: number;
  /** 0 while the field is empty: one. */
  seeds: number;
  vary: "nothing" | "grid" | "hypercube" | "table";
  grid: Row[];
  ranges: RangeRow[];
  /** 0 while the field is empty: one. */
  points: number;
  hypercubeSeed: number;
  /** Rows of a design from outside: CSV text whose header has the paths. */
  table: string;
  /** Devices drawn from the process spread; 0: the scenario's own. */
  devices: number;
}

export const EMPTY_ROW: Row = { path: "", text: "" };
export const EMPTY_RANGE: RangeRow = { path: "", min: "", max: "", log: false };

export function newDraft(scenario: string): Draft {
  return {
    kind: "run",
    scenario,
    label: "",
    set: [],
    all: false,
    firstSeed: 1,
    seeds: 1,
    vary: "grid",
    grid: [EMPTY_ROW],
    ranges: [EMPTY_RANGE],
    points: 20,
    hypercubeSeed: 1,
    table: "",
    devices: 0,
  };
}

/** A typed value: a number, a truth value, a list or table in JSON; anything else is text. */
export function parseValue(text: string): unknown {
  const trimmed = text.trim();
  try {
    return JSON.parse(trimmed.replace("−", "-"));
  } catch {
    return trimmed;
  }
}

/** A number as it was typed; the server refuses another value and names its field. */
const numberOf = (text: string) => parseValue(text) as number;

/** Several values, separated by commas; "1:10:4" is four values evenly spaced from 1 to 10. */
export function parseValues(text: string): unknown[] {
  return text
    .split(",")
    .filter((piece) => piece.trim() !== "")
    .flatMap((piece) => {
      const span = /^\s*(\S+)\s*:\s*(\S+)\s*:\s*(\d+)\s*$/.exec(piece);
      const [low, high, count] = span ? span.slice(1).map(Number) : [];
      if (!span || !Number.isFinite(low) || !Number.isFinite(high) || count < 2) return [parseValue(piece)];
      return Array.from({ length: count }, (_, i) => roundTo(low + ((high - low) * i) / (count - 1), 12));
    });
}

const filled = <T extends { path: string }>(rows: readonly T[]) => rows.filter((row) => row.path.trim() !== "");

/** How many rows CSV text has below its header. */
const rowCount = (text: string) => Math.max(0, text.split("\n").filter((line) => line.trim() !== "").length - 1);

/** How many points a campaign has. */
export function pointCount(draft: Draft): number {
  const varied =
    draft.vary === "grid"
      ? filled(draft.grid).reduce((product, row) => product * Math.max(1, parseValues(row.text).length), 1)
      : draft.vary === "hypercube" && filled(draft.ranges).length > 0
        ? Math.max(1, draft.points)
        : draft.vary === "table"
          ? Math.max(1, rowCount(draft.table))
          : 1;
  return varied * Math.max(1, draft.devices);
}

const setOf = (rows: readonly Row[]) =>
  Object.fromEntries(filled(rows).map((row) => [row.path.trim(), parseValue(row.text)]));

/** Seeds as they are counted everywhere: both ends included. */
const spanOf = (first: number, count: number) => `${first}:${first + Math.max(1, count) - 1}`;

/** The request for a run. */
export function runOf(draft: Draft) {
  const { scenario, label, all, firstSeed, seeds } = draft;
  return { scenario, label, all, set: setOf(draft.set), seeds: spanOf(firstSeed, seeds) };
}

/** The campaign's document, as a file would have it. */
export function campaignOf(draft: Draft): Campaign {
  const { scenario, firstSeed, seeds, vary, points, hypercubeSeed, table, devices } = draft;
  const ranges = filled(draft.ranges);
  return {
    schema: 1,
    id: scenario.toLowerCase(),
    scenario,
    set: setOf(draft.set),
    seeds: spanOf(firstSeed, seeds),
    ...(vary === "grid" && {
      grid: Object.fromEntries(filled(draft.grid).map((row) => [row.path.trim(), parseValues(row.text)])),
    }),
    ...(vary === "hypercube" &&
      ranges.length > 0 && {
        latin_hypercube: {
          points: Math.max(1, points),
          seed: hypercubeSeed,
          ranges: Object.fromEntries(
            ranges.map(({ path, min, max, log }) => [
              path.trim(),
              { min: numberOf(min), max: numberOf(max), scale: log ? ("log" as const) : ("linear" as const) },
            ]),
          ),
        },
      }),
    ...(vary === "table" && { points: { csv: table } }),
    ...(devices > 0 && { process_spread: { devices } }),
  };
}

/** Dotted paths of all single values of a scenario, to choose from. */
export function pathsOf(document: unknown, prefix = ""): string[] {
  if (document === null || typeof document !== "object" || Array.isArray(document)) return prefix ? [prefix] : [];
  return Object.entries(document)
    .filter(([key, value]) => prefix || (!HEAD.includes(key) && !Array.isArray(value)))
    .flatMap(([key, value]) => pathsOf(value, prefix ? `${prefix}.${key}` : key));
}

/** A path in words: "sensor.noise_um" reads "noise, µm · sensor". */
export function pathTitle(path: string): string {
  const [last = "", ...outer] = path.split(".").reverse();
  const of = outer.reverse().join(" ").replaceAll("_", " ");
  return of ? `${metricTitle(last)} · ${of}` : metricTitle(last);
}

/** Parts of a scenario that are about it. */
const HEAD = ["schema", "id", "title", "source", "summary", "claim", "verdict", "metrics"];
