import type { Trigger } from "../../stream/wire";

/** What a scope shows; kept with the layout. */
export interface ScopeConfig {
  signals: string[];
  mode: "roll" | "triggered";
  windowMs: number;
  trigger: Trigger;
  /** Whether cursors and figures are shown. */
  measure?: boolean;
}

export const DEFAULT_TRIGGER: Trigger = {
  signal: "reference.voltage",
  edge: "rising",
  level: 0,
  hysteresis: 0.1,
  position: 0.1,
  sweep: "auto",
};

export function scopeConfig(signals: string[], rest: Partial<ScopeConfig> = {}): ScopeConfig {
  return { signals, mode: "roll", windowMs: 4, trigger: DEFAULT_TRIGGER, ...rest };
}
