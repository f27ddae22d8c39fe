import { DASHES, HYPOTHESES, type Scheme, SIGNALS, TRACE_COLOURS } from "./palette";

interface TraceStyle {
  /** Slot in `TRACE_COLOURS`. */
  slot: number;
  /** Index in `DASHES`. */
  dash: number;
}

const BANKS =
  /^[^.]+\.(?:probability|residual(?:_[a-z]+)?|(?:velocity_)?gain_(?!ideal)[a-z_]+|log_likelihood|likelihood)\.(.+)$/;

/** A signal of a twin: the twin, and the same signal of the board. */
const OF_TWIN = /^([^:]+):(.+)$/;

/**
 * Colour and dash of a signal: the same in every panel, because it depends on the bench alone.
 *
 * Signals of a hypothesis share the hypothesis' colour; the rest take slots in the order the bench lists them. The same
 * signal of each twin takes the next colour, so that a scope of twins tells them apart.
 */
export function traceStyle(name: string, signals: readonly string[], hypotheses: readonly string[]): TraceStyle {
  const known = SIGNALS[name];
  if (known) return { slot: known[0], dash: known[1] };
  const label = BANKS.exec(name)?.[1];
  const hypothesis = label === undefined ? -1 : hypotheses.indexOf(label);
  if (hypothesis >= 0) return hypothesisStyle(hypothesis);
  const slots = TRACE_COLOURS.dark.length;
  const [, twin, own] = OF_TWIN.exec(name) ?? [];
  if (own) {
    const twins = [...new Set(signals.flatMap((s) => OF_TWIN.exec(s)?.[1] ?? []))];
    const { slot, dash } = traceStyle(own, signals, hypotheses);
    return { slot: 1 + ((slot + twins.indexOf(twin)) % (slots - 1)), dash };
  }
  const at = Math.max(0, signals.filter((s) => !SIGNALS[s] && !BANKS.test(s)).indexOf(name));
  return { slot: 1 + (at % (slots - 1)), dash: (at + Math.floor(at / (slots - 1))) % DASHES.length };
}

export function hypothesisStyle(index: number): TraceStyle {
  const round = Math.floor(index / HYPOTHESES.length);
  return { slot: HYPOTHESES[index % HYPOTHESES.length], dash: round % DASHES.length };
}

export function traceColour(style: TraceStyle, scheme: Scheme): string {
  return TRACE_COLOURS[scheme][style.slot];
}
