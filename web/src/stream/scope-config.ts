import type { Trigger } from "./wire";

/** The settings of a scope; stored with the layout. */
export interface ScopeConfig {
  signals: string[];
  mode: "roll" | "triggered";
  windowMs: number;
  trigger: Trigger;
  /** Whether magnitudes are shown on a logarithmic scale. */
  log?: boolean;
  /** Whether cursors and figures are shown. */
  measure?: boolean;
  /** The places of cursors A and B, as shares of the width. */
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
const ACTIVE = /^@active(?=\.)/;

/** Of the controllers that drove, a scope shows the newest. */
const MOST_DRIVEN = 3;

/** The names of a signal on a bench: one, or a name for each of some controllers, the newest first. */
export function namedFor(signal: string, controllers: readonly string[]): string[] {
  if (!ACTIVE.test(signal)) return [signal];
  return [...new Set(controllers)].slice(0, MOST_DRIVEN).map((controller) => signal.replace(ACTIVE, controller));
}

/**
 * A scope as it is on a bench: the controllers that drive or drove by name, the trigger on a signal that there is.
 *
 * A switch of the controller so changes the traces of a scope.
 */
export function onBench(
  config: ScopeConfig,
  signals: readonly { name: string }[],
  controllers: readonly string[],
): ScopeConfig {
  const named = config.signals.flatMap((name) => namedFor(name, controllers));
  const known = signals.some((s) => s.name === config.trigger.signal) || named.length === 0;
  return { ...config, signals: named, trigger: known ? config.trigger : { ...config.trigger, signal: named[0] } };
}

export function scopeConfig(signals: string[], rest: Partial<ScopeConfig> = {}): ScopeConfig {
  return { signals, mode: "roll", windowMs: 4, trigger: DEFAULT_TRIGGER, ...rest };
}
