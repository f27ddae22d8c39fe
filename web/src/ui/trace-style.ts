import { DASHES, HYPOTHESES, type Scheme, SIGNALS, TRACE_COLOURS } from "./palette";

interface TraceStyle {
  /** Slot in `TRACE_COLOURS`. */
  slot: number;
  /** Index in `DASHES`. */
  dash: number;
}

const BANKS =
  /^[^.]+\.(?:probability|residual(?:_[a-z]+)?|(?:velocity_)?gain_(?!ideal)[a-z_]+|log_likelihood|likelihood)\.(.+)$/;

/**
 * Colour and dash of a signal: the same in every panel, because it depends on the bench alone.
 *
 * Signals of a hypothesis share the hypothesis' colour; the rest take slots in the order the bench lists them.
 */
export function traceStyle(name: string, signals: readonly string[], hypotheses: readonly string[]): TraceStyle {
  const known = SIGNALS[name];
  if (known) return { slot: known[0], dash: known[1] };
  const label = BANKS.exec(name)?.[1];
  const hypothesis = label === undefined ? -1 : hypotheses.indexOf(label);
  if (hypothesis >= 0) return hypothesisStyle(hypothesis);
  const at = Math.max(0, signals.filter((s) => !SIGNALS[s] && !BANKS.test(s)).indexOf(name));
  const slots = TRACE_COLOURS.dark.length;
  return { slot: 1 + (at % (slots - 1)), dash: (at + Math.floor(at / (slots - 1))) % DASHES.length };
}

export function hypothesisStyle(index: number): TraceStyle {
  const round = Math.floor(index / HYPOTHESES.length);
  return { slot: HYPOTHESES[index % HYPOTHESES.length], dash: round % DASHES.length };
}

export function traceColour(style: TraceStyle, scheme: Scheme): string {
  return TRACE_COLOURS[scheme][style.slot];
}
