import type { Trigger } from "./wire";

/** What a scope shows; kept with the layout. */
export interface ScopeConfig {
  signals: string[];
  mode: "roll" | "triggered";
  windowMs: number;
  trigger: Trigger;
  /** Whether magnitudes are shown on a logarithmic scale. */
  log?: boolean;
  /** Whether cursors and figures are shown. */
  measure?: boolean;
  /** Where cursors A and B stand, as shares of the width. */
  cursors?: [number, number];
}

export const DEFAULT_TRIGGER: Trigger = {
  signal: "reference.voltage",
  edge: "rising",
  level: 0,
  upper: null,
  hysteresis: 0.1,
  position: 0.1,
  sweep: "auto",
};

/** Stands for the controller that drives, in the names of signals. */
const ACTIVE = "@active.";

/**
 * A scope as it is on a bench: the controller that drives by its name, the trigger on a signal that there is.
 *
 * A switch of the controller so changes what a scope shows.
 */
export function onBench(config: ScopeConfig, signals: readonly { name: string }[], controller: string): ScopeConfig {
  const named = config.signals.map((name) => (name.startsWith(ACTIVE) ? name.replace(/^@active/, controller) : name));
  const known = signals.some((s) => s.name === config.trigger.signal) || named.length === 0;
  return { ...config, signals: named, trigger: known ? config.trigger : { ...config.trigger, signal: named[0] } };
}

export function scopeConfig(signals: string[], rest: Partial<ScopeConfig> = {}): ScopeConfig {
  return { signals, mode: "roll", windowMs: 4, trigger: DEFAULT_TRIGGER, ...rest };
}
