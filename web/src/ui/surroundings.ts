/** A number of a device with a knob: its path and its range. */
export interface Knob {
  path: string;
  label: string;
  unit: string;
  low: number;
  high: number;
  step: number;
  /** Turned by ratios rather than differences. */
  log?: boolean;
}

export interface KnobGroup {
  title: string;
  knobs: Knob[];
}

export const AIR: Record<string, number> = { temperature_k: 300, pressure_pa: 101325, humidity_pct: 40 };

/** The surroundings of a device with a knob each. */
export const ENVIRONMENT: Knob[] = [
  { path: "temperature_k", label: "Temperature", unit: "K", low: 150, high: 600, step: 1 },
  { path: "pressure_pa", label: "Pressure", unit: "Pa", low: 0.1, high: 1e6, step: 0, log: true },
  { path: "humidity_pct", label: "Relative humidity", unit: "%", low: 0, high: 100, step: 1 },
];

/** The surroundings of a gyroscope: its package keeps the air out. */
export const AROUND_A_PACKAGE = ENVIRONMENT.filter(({ path }) => path === "temperature_k");
