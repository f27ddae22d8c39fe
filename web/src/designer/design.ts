import type { Design, Device, NewBench } from "../api/types";
import { roundTo } from "../ui/unit-scale";

/** The changes of a device of the catalogue, and the air around it. */
export interface DesignState {
  id: string;
  /** Values written over the catalogue's, by dotted path below `device`. */
  changes: Record<string, number | string>;
  environment: Record<string, number>;
  /** The geometry of a device drawn from the process. */
  drawn: { seed: number; geometry: Record<string, number> } | undefined;
}

export const newDesign = (id: string): DesignState => ({ id, changes: {}, environment: {}, drawn: undefined });

/** Whether a device of the catalogue is a gyroscope made from a drawing. */
export const isDrawnGyroscope = (device: Device | undefined): boolean =>
  device?.parameters.drawn_gyroscope !== undefined;

/** Whether a device of the catalogue is a gyroscope, by its numbers or by its drawing. */
export const isGyroscope = (device: Device | undefined): boolean =>
  device?.parameters.gyroscope !== undefined || isDrawnGyroscope(device);

/** The device as a scenario would have it. */
export function designDocument({ id, changes, environment, drawn }: DesignState): Design {
  let device: Table = { id, ...(drawn && { geometry: drawn.geometry }) };
  for (const [path, value] of Object.entries(changes)) device = written(device, path.split("."), value);
  return { device, environment };
}

type Table = Record<string, unknown>;

/** A table with one value written, however deep. */
const written = (table: Table, [key, ...below]: string[], value: unknown): Table => ({
  ...table,
  [key]: below.length === 0 ? value : written((table[key] ?? {}) as Table, below, value),
});

/** A design with one value changed, which replaces the value drawn from the process. */
export function changed(state: DesignState, path: string, value: number, original: number): DesignState {
  const changes = { ...state.changes, [path]: value };
  if (value === original) delete changes[path];
  const name = path.replace(/^geometry\./, "");
  if (!state.drawn || !(name in state.drawn.geometry)) return { ...state, changes };
  const { [name]: _, ...geometry } = state.drawn.geometry;
  return { ...state, changes, drawn: { ...state.drawn, geometry } };
}

/** Value in force: changed, drawn, or the catalogue's. */
export function valueIn(state: DesignState, path: string, original: number): number {
  const own = state.changes[path];
  return typeof own === "number" ? own : (state.drawn?.geometry[path.replace(/^geometry\./, "")] ?? original);
}

/** A design with values written below a table that the catalogue does not have, or without this table. */
export function withTable(state: DesignState, table: string, values: Record<string, number> | undefined): DesignState {
  const others = Object.entries(state.changes).filter(([path]) => !path.startsWith(`${table}.`));
  const own = Object.entries(values ?? {}).map(([name, value]) => [`${table}.${name}`, value]);
  return { ...state, changes: Object.fromEntries([...others, ...own]) };
}

/** The values of a design below a table; undefined without it. */
export function tableIn({ changes }: DesignState, table: string): Record<string, number> | undefined {
  const own = Object.entries(changes).filter(([path]) => path.startsWith(`${table}.`));
  if (own.length === 0) return undefined;
  return Object.fromEntries(own.map(([path, value]) => [path.slice(table.length + 1), Number(value)]));
}

/** A design whose comb has the field of a choice; the field of plates alone without one. */
export function withFringing(state: DesignState, fringing: string): DesignState {
  const { fringing: _, ...changes } = state.changes;
  return { ...state, changes: fringing ? { ...changes, fringing } : changes };
}

/** Value of the catalogue by a dotted path; undefined when the device has none. */
export function catalogued(device: Device | undefined, path: string): number | undefined {
  let at: unknown = device?.parameters;
  for (const key of path.split(".")) at = (at as Record<string, unknown> | undefined)?.[key];
  return typeof at === "number" ? at : undefined;
}

const TRAVEL_UM = 3;
const MOST_V = 10;
const SAMPLES_PER_PERIOD = 20;

/** A bench with the device on it, driven below its resonance and not beyond some micrometres. */
export function benchOf(design: Design, title: string, metrics: Record<string, number>): NewBench {
  const frequency = round(0.8 * metrics.f0_hz);
  const ratio = 0.8;
  const gain =
    Math.abs(metrics.static_gain_um_per_v) /
    Math.hypot(1 - ratio * ratio, ratio / Math.max(metrics.quality_factor, 1e-6));
  const amplitude = gain > 0 ? Math.min(MOST_V, TRAVEL_UM / gain) : MOST_V;
  return {
    scenario: "first-look",
    paused: false,
    set: {
      title: `Designed: ${title}`,
      device: design.device ?? {},
      environment: design.environment ?? {},
      sample_rate_khz: sampleRate(metrics),
      "reference.frequency_hz": frequency,
      "reference.amplitude_v": round(amplitude),
    },
  };
}

/**
 * A bench of a gyroscope: force to rebalance at a steady rate, with a read-out of its noise.
 *
 * Combs that the design has are driven by volts, and a tuning electrode has its voltage.
 */
export function gyroscopeBenchOf(design: Design, title: string, metrics: Record<string, number>): NewBench {
  const electrodes = (design.device?.electrodes ?? {}) as Partial<Record<"drive" | "sense" | "tuning", unknown>>;
  const hasCombs = ["x", "y"].every((axis) => `gyro.force_${axis}_nn_per_v2` in metrics);
  return {
    scenario: {
      title: `Designed: ${title}`,
      source: "device designer",
      ...((electrodes.drive || electrodes.sense) && hasCombs ? { drive: { by: "volts" } } : {}),
      ...(electrodes.tuning ? { plant: { model: "tuned_gyroscope" } } : {}),
      sample_rate_khz: sampleRate(metrics),
      device: design.device ?? {},
      environment: design.environment ?? {},
      rate: { kind: "constant", deg_per_s: 100 },
      controller: { kind: "force_to_rebalance" },
      readouts: { allan: { kind: "allan" } },
    },
    set: {},
    paused: false,
  };
}

/** The first look at a gyroscope with a device of the catalogue. */
export const firstLookOf = ({ id, metrics }: Device): NewBench => ({
  scenario: "gyro-first-look",
  set: { device: { id }, sample_rate_khz: sampleRate(metrics) },
  paused: false,
  quiet_lead: true,
});

const sampleRate = (metrics: Record<string, number>) =>
  Math.max(100, Math.ceil((SAMPLES_PER_PERIOD * metrics.f0_hz) / 1e3));

const round = (value: number) => roundTo(value, 2);
