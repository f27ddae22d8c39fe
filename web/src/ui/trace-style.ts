import { DASHES, type Scheme, TRACE_COLOURS } from "./palette";

export interface TraceStyle {
  /** Slot in `TRACE_COLOURS`. */
  slot: number;
  /** Index in `DASHES`. */
  dash: number;
}

/** The signals everybody looks at keep a colour that can be remembered. */
const KNOWN: Record<string, TraceStyle> = {
  "model.displacement": { slot: 0, dash: 1 },
  "plant.displacement": { slot: 1, dash: 0 },
  "sensor.displacement": { slot: 3, dash: 2 },
  "reference.voltage": { slot: 2, dash: 0 },
  "drive.voltage": { slot: 5, dash: 4 },
  "plant.velocity": { slot: 4, dash: 0 },
};

const BANKS = /^[^.]+\.(?:probability|residual|log_likelihood|likelihood)\.(.+)$/;

/**
 * Colour and dash of a signal: the same in every panel, because it depends on the bench alone.
 *
 * Signals of a hypothesis share the hypothesis' colour; the rest take slots in the order the bench lists them.
 */
export function traceStyle(name: string, signals: readonly string[], hypotheses: readonly string[]): TraceStyle {
  const known = KNOWN[name];
  if (known) return known;
  const label = BANKS.exec(name)?.[1];
  const hypothesis = label === undefined ? -1 : hypotheses.indexOf(label);
  if (hypothesis >= 0) return hypothesisStyle(hypothesis);
  const at = Math.max(0, signals.filter((s) => !KNOWN[s] && !BANKS.test(s)).indexOf(name));
  const slots = TRACE_COLOURS.dark.length;
  return { slot: 1 + (at % (slots - 1)), dash: (at + Math.floor(at / (slots - 1))) % DASHES.length };
}

export function hypothesisStyle(index: number): TraceStyle {
  const order = [3, 2, 5, 1, 4, 6, 7, 0];
  return { slot: order[index % order.length], dash: Math.floor(index / order.length) % DASHES.length };
}

export function traceColour(style: TraceStyle, scheme: Scheme): string {
  return TRACE_COLOURS[scheme][style.slot];
}
