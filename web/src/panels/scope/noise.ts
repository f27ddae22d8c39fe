import { middles, type PanelFrame } from "../../stream/panel-frame";

/** Multiples of the drive's frequency that are signal. */
const HARMONICS = 5;
/** Parts of a window; from the differences between them follows the spread of the whole. */
const PARTS = 10;
/** A difference of so many spreads is not by chance. */
const SURE = 4;
/** Neighbours of more correlation than before are an oscillation that decays, not noise. */
const ALIKE = 0.2;
/** A smaller share of a signal is the rounding of its numbers. */
const ROUNDING = 1e-6;

/** What remains of a signal without its mean, the tone of the drive and the harmonics. */
export interface Noise {
  rms: number;
  /** Standard error of the RMS. */
  spread: number;
  /** Correlation of a sample with the next. */
  likeness: number;
}

/** The noise of a signal over some of the samples of a frame. */
export function noiseOf(
  frame: PanelFrame,
  signal: number,
  period: number | null | undefined,
  from = 0,
  until = frame.columns,
): Noise {
  const samples = Float64Array.from(middles(frame, signal).subarray(from, until));
  const all = dot(samples, samples);
  const signalBasis = basis(samples.length, period);
  for (const one of signalBasis) subtract(samples, one, dot(samples, one));
  const size = Math.floor(samples.length / PARTS);
  const powers = Array.from({ length: PARTS }, (_, i) => {
    const part = samples.subarray(i * size, (i + 1) * size);
    return dot(part, part) / size;
  });
  const left = dot(samples, samples);
  if (left < ROUNDING ** 2 * all) return { rms: 0, spread: 0, likeness: 0 };
  const rms = Math.sqrt(left / (samples.length - signalBasis.length));
  const mean = powers.reduce((sum, one) => sum + one, 0) / PARTS;
  const variance = powers.reduce((sum, one) => sum + (one - mean) ** 2, 0) / (PARTS - 1);
  return {
    rms,
    spread: Math.sqrt(variance / PARTS) / (2 * rms),
    likeness: dot(samples.subarray(1), samples.subarray(0, -1)) / left,
  };
}

/** Whether one of two noises is surely larger. */
export function differ(one: Noise, other: Noise): boolean {
  const [small, large] = one.rms < other.rms ? [one, other] : [other, one];
  return (
    large.rms - small.rms > SURE * Math.hypot(one.spread, other.spread) && large.likeness <= small.likeness + ALIKE
  );
}

/** A constant, the drive's tone and its harmonics over so many samples, at right angles and of length 1. */
function basis(count: number, period: number | null | undefined): Float64Array[] {
  const found: Float64Array[] = [];
  const add = (at: (i: number) => number) => {
    const one = Float64Array.from({ length: count }, (_, i) => at(i));
    for (const other of found) subtract(one, other, dot(one, other));
    const length = Math.sqrt(dot(one, one));
    found.push(one.map((value) => value / length));
  };
  add(() => 1);
  for (let k = 1; period && k <= HARMONICS && 2 * k < period; k += 1) {
    const turn = (2 * Math.PI * k) / period;
    add((i) => Math.cos(turn * i));
    add((i) => Math.sin(turn * i));
  }
  return found;
}

/** The scalar product of two lists, as long as the first. */
function dot(a: Float64Array, b: Float64Array): number {
  let sum = 0;
  for (let i = 0; i < a.length; i += 1) sum += a[i] * b[i];
  return sum;
}

function subtract(from: Float64Array, what: Float64Array, times: number): void {
  for (let i = 0; i < from.length; i += 1) from[i] -= times * what[i];
}
