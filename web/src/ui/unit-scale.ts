/** How numbers of one unit are shown on one axis or in one readout: factor, unit text and decimals. */
export interface UnitScale {
  /** Shown value = value x factor. */
  factor: number;
  unit: string;
  decimals: number;
}

const BASE: Record<string, [number, string]> = {
  um: [1e-6, "m"],
  nm: [1e-9, "m"],
  mm: [1e-3, "m"],
  m: [1, "m"],
  ms: [1e-3, "s"],
  us: [1e-6, "s"],
  s: [1, "s"],
  "um/ms": [1e-3, "m/s"],
  "m/s": [1, "m/s"],
  V: [1, "V"],
  mV: [1e-3, "V"],
  Hz: [1, "Hz"],
  kHz: [1e3, "Hz"],
  N: [1, "N"],
  uN: [1e-6, "N"],
  "N/m": [1, "N/m"],
  "N/V": [1, "N/V"],
  "N s/m": [1, "N·s/m"],
  "um/V": [1e-6, "m/V"],
  kg: [1e3, "g"],
  mg: [1e-3, "g"],
  F: [1, "F"],
  Pa: [1, "Pa"],
  A: [1, "A"],
  W: [1, "W"],
};

const PREFIXES: [number, string][] = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
  [1e-15, "f"],
];

/**
 * The scale on which `magnitude` (the largest value to be shown) reads as 1 to 999 of a prefixed unit.
 *
 * Chosen once per axis, so that a value passing through zero does not change its unit.
 */
export function unitScale(unit: string, magnitude: number, digits = 4): UnitScale {
  const size = Math.abs(magnitude);
  if (unitText(unit) === "") return { factor: 1, unit: "", decimals: decimalsFor(size, digits) };
  const base = BASE[unit];
  if (!base) return { factor: 1, unit: unitText(unit), decimals: decimalsFor(size, digits) };
  const [toBase, name] = base;
  const inBase = size * toBase;
  const [scale, prefix] =
    (size > 0 && PREFIXES.find(([p]) => inBase >= p * 0.9999995)) || (size > 0 ? PREFIXES[8] : plain(toBase));
  return { factor: toBase / scale, unit: prefix + name, decimals: decimalsFor(inBase / scale, digits) };
}

/** Zero keeps the unit it came in. */
function plain(toBase: number): [number, string] {
  return PREFIXES.find(([p]) => p <= toBase * 1.001) ?? [1, ""];
}

function decimalsFor(shown: number, digits: number): number {
  if (!(shown > 0)) return digits - 1;
  const before = Math.floor(Math.log10(shown * 1.0000005)) + 1; // what reads as 1 counts as 1
  return Math.max(0, Math.min(digits + 2, digits - before));
}

/** Numbers without a unit, and vectors whose components differ in theirs. */
const BARE = ["", "1", "mixed"];

/** A unit the way people write it. */
export function unitText(unit: string): string {
  if (BARE.includes(unit)) return "";
  return unit
    .replace(/\bu(?=[A-Za-z])/g, "µ")
    .replaceAll("*", "·")
    .replaceAll("^2", "²")
    .replaceAll("^3", "³");
}
