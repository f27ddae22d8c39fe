/** What the server says, in its own words. Optional fields are those a status may leave out. */

export interface ApiErrorBody {
  code: string;
  message: string;
  field: string;
  hint: string;
}

export interface Signal {
  name: string;
  unit: string;
  meaning: string;
  block: string;
  kind: "output" | "tap";
  index: number;
}

export type FaultProfile =
  | { kind: "step" }
  | { kind: "ramp"; duration_ms: number }
  | { kind: "intermittent"; period_ms: number; duty: number };

export interface ActiveFault {
  name: string;
  severity: number;
  profile?: FaultProfile | string;
  since_tick?: number;
}

export interface Trip {
  tick: number;
  reason: string;
  signal: string;
  value: number;
}

export type BenchState = "running" | "paused" | "tripped";

export type Document = { [key: string]: unknown };

export interface Bench {
  id: string;
  title: string;
  scenario_id: string;
  created: string;
  state: BenchState;
  tick: number;
  dt_ms: number;
  sample_rate_khz: number;
  time_scale: number | null;
  achieved_scale: number;
  capped: boolean;
  overruns: number;
  given_up_ms: number;
  controller: string;
  faults: ActiveFault[];
  watchers: number;
  signals: Signal[];
  controllers: string[];
  diagnosers: Record<string, { names: string[] }>;
  parameters: Document;
  view3d: string | null;
  trip?: Trip | null;
}

export interface Score {
  correct_fraction: number;
  false_switches: number;
  delays: (number | null)[];
  winner: number | string | null;
  truth: number | string | null;
  names?: string[];
  confusion?: number[][];
}

export interface LogEntry {
  seq: number;
  tick: number;
  actor: string;
  kind: string;
  text: string;
  command: { kind?: string; [key: string]: unknown } | null;
  old: unknown;
  new: unknown;
}

export interface Equation {
  label: string;
  latex: string;
  source: string;
  printed: string | null;
  why: string | null;
}

export interface Parameter {
  name: string;
  label: string;
  unit: string;
  default: unknown;
  minimum: number | null;
  maximum: number | null;
  meaning: string;
  equation: string;
  live: boolean;
  type: "number" | "integer" | "boolean" | "choice" | "text" | "list" | "table";
  choices: string[] | null;
}

export interface Port {
  name: string;
  unit: string;
  meaning: string;
  labels: string[];
  each: string;
}

export interface BlockCard {
  family: string;
  name: string;
  title: string;
  summary: string;
  /** For faults: what it changes, where it shows, and a severity worth trying. */
  changes: string | null;
  shows: string | null;
  suggested: number | null;
  equations: Equation[];
  parameters: Parameter[];
  inputs: Port[];
  outputs: Port[];
  taps: Port[];
}

export interface Device {
  id: string;
  title: string;
  source: string;
  notes: string;
}

export interface ScenarioSummary {
  id: string;
  title: string;
  source: string;
  summary: string;
  verdict: string;
}

export type Command =
  | { kind: "start" | "pause" | "step_period" | "reset" | "reset_trip" }
  | { kind: "step"; ticks: number }
  | { kind: "time_scale"; value: number | null }
  | { kind: "switch"; controller: string; cold: boolean }
  | { kind: "heal"; faults: string[] | "all" }
  | { kind: "set"; values: Record<string, unknown> }
  | {
      kind: "inject";
      fault: string;
      severity: number;
      profile: FaultProfile;
      at_ms?: number;
      when?: string;
    };
