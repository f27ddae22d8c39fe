import { extent } from "../phase/phase-range";

/** A trace as columns of equal width: where a column holds one sample, both ends are that sample. */
export interface Columns {
  low: ArrayLike<number>;
  high: ArrayLike<number>;
}

export interface Measurement {
  rms: number;
  /** Largest distance from zero. */
  peak: number;
  /** kHz when times are in ms; undefined without two like crossings of the mean. */
  frequency: number | undefined;
  /** Degrees behind the reference, at the reference's frequency. */
  phaseLag: number | undefined;
  /** Amplitude over the amplitude of the reference, both at its frequency. */
  ratio: number | undefined;
  /** Share beyond a constant reference. */
  overshoot: number | undefined;
  /** Time from the left edge until the distance to the reference stays within its band. */
  settling: number | undefined;
}

/** Part of the reference's amplitude that counts as settled; as in the figures of a run. */
const BAND = 0.02;
/** Columns a period needs for its shape to be seen. */
const LEAST = 6;

const middle = ({ low, high }: Columns, i: number) => (low[i] + high[i]) / 2;

/** Figures of a trace over a span, and against its reference if there is one. */
export function measure(trace: Columns, width: number, reference?: Columns): Measurement | undefined {
  const n = trace.low.length;
  let square = 0;
  let peak = 0;
  let count = 0;
  for (let i = 0; i < n; i += 1) {
    const low = trace.low[i];
    const high = trace.high[i];
    if (Number.isNaN(low)) continue;
    // the mean square of a line from one end to the other, exact for a column of one sample
    square += (low * low + low * high + high * high) / 3;
    peak = Math.max(peak, Math.abs(low), Math.abs(high));
    count += 1;
  }
  if (count === 0) return undefined;
  const beat = reference && frequencyOf(reference, width);
  const mine = beat ? phasor(trace, beat * width) : undefined;
  const theirs = beat && reference ? phasor(reference, beat * width) : undefined;
  return {
    rms: Math.sqrt(square / count),
    peak,
    frequency: frequencyOf(trace, width),
    phaseLag: mine && theirs && Math.hypot(...theirs) > 0 ? lag(theirs, mine) : undefined,
    ratio: mine && theirs && Math.hypot(...theirs) > 0 ? Math.hypot(...mine) / Math.hypot(...theirs) : undefined,
    ...(reference ? follow(trace, width, reference) : { overshoot: undefined, settling: undefined }),
  };
}

/** From the first to the last rising crossing of the mean, with a tenth of the swing as hysteresis. */
function frequencyOf(trace: Columns, width: number): number | undefined {
  const n = trace.low.length;
  const [low] = extent(trace.low) ?? [];
  const high = extent(trace.high)?.[1];
  if (low === undefined || high === undefined || low === high) return undefined;
  const mean = (low + high) / 2;
  const dead = (high - low) / 10;
  let below = false;
  const crossings: number[] = [];
  for (let i = 1; i < n; i += 1) {
    const before = middle(trace, i - 1);
    const now = middle(trace, i);
    if (now < mean - dead) below = true;
    if (!below || !(before < mean && now >= mean)) continue;
    crossings.push(i - 1 + (mean - before) / (now - before));
    below = false;
  }
  if (crossings.length < 2) return undefined;
  const period = (crossings[crossings.length - 1] - crossings[0]) / (crossings.length - 1);
  return period >= LEAST ? 1 / (period * width) : undefined;
}

/** Real and imaginary part of a tone of so many cycles each column, over whole periods, the newest. */
function phasor(trace: Columns, cycles: number): [number, number] | undefined {
  const n = trace.low.length;
  const periods = Math.floor(n * cycles);
  const used = Math.round(periods / cycles);
  let re = 0;
  let im = 0;
  for (let i = n - used; i < n; i += 1) {
    const value = middle(trace, i);
    if (Number.isNaN(value)) return undefined;
    re += value * Math.cos(2 * Math.PI * cycles * i);
    im -= value * Math.sin(2 * Math.PI * cycles * i);
  }
  return [(2 * re) / used, (2 * im) / used];
}

/** How many degrees the second is behind the first, from -180 to 180. */
function lag([ar, ai]: [number, number], [br, bi]: [number, number]): number {
  const degrees = ((Math.atan2(ai, ar) - Math.atan2(bi, br)) * 180) / Math.PI;
  return ((degrees + 540) % 360) - 180;
}

function follow(trace: Columns, width: number, reference: Columns): Pick<Measurement, "overshoot" | "settling"> {
  const n = Math.min(trace.low.length, reference.low.length);
  let swing = 0;
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < n; i += 1) {
    if (Number.isNaN(reference.low[i])) continue;
    low = Math.min(low, reference.low[i]);
    high = Math.max(high, reference.high[i]);
    swing = Math.max(swing, Math.abs(reference.low[i]), Math.abs(reference.high[i]));
  }
  if (swing === 0) return { overshoot: undefined, settling: undefined };
  let last = -1;
  let most = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < n; i += 1) {
    const value = middle(trace, i);
    if (Math.abs(value - middle(reference, i)) > BAND * swing) last = i;
    most = Math.max(most, high > 0 ? trace.high[i] : -trace.low[i]);
  }
  const isConstant = high - low <= 1e-3 * swing;
  return {
    overshoot: isConstant ? most / swing - 1 : undefined,
    // a trace outside the band at the very end has not settled
    settling: last === n - 1 ? undefined : (last + 1) * width,
  };
}

/** The reference of a trace: the reference voltage for voltages, the model for displacements. */
export function referenceFor(name: string, unit: string, traces: readonly { name: string; unit: string }[]) {
  const wanted = /^(?:[^:]+:)?(?:reference|model)\./;
  const found = traces.findIndex((t) => t.unit === unit && wanted.test(t.name));
  return found >= 0 && traces[found].name !== name ? found : undefined;
}
