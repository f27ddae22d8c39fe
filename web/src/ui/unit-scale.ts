/** How numbers of one unit are shown on one axis or in one readout: factor, unit text and decimals. */
export interface UnitScale {
  /** Shown value = value x factor. */
  factor: number;
  unit: string;
  decimals: number;
  /** Power of ten behind the number where no prefix reaches, such as "×10⁻⁶"; else empty. */
  exponent: string;
}

/** Units that take prefixes: the factor to the base unit, and its name. */
export const UNITS: Record<string, [number, string]> = {
  m: [1, "m"],
  mm: [1e-3, "m"],
  um: [1e-6, "m"],
  nm: [1e-9, "m"],
  s: [1, "s"],
  ms: [1e-3, "s"],
  us: [1e-6, "s"],
  ns: [1e-9, "s"],
  "s/s": [1, "s/s"],
  "m/s": [1, "m/s"],
  "um/ms": [1e-3, "m/s"],
  V: [1, "V"],
  mV: [1e-3, "V"],
  Hz: [1, "Hz"],
  kHz: [1e3, "Hz"],
  rad: [1, "rad"],
  mrad: [1e-3, "rad"],
  N: [1, "N"],
  uN: [1e-6, "N"],
  nN: [1e-9, "N"],
  "N/m": [1, "N/m"],
  "uN/um": [1, "N/m"],
  "N/V": [1, "N/V"],
  "uN/V": [1e-6, "N/V"],
  "N s/m": [1, "N·s/m"],
  "um/V": [1e-6, "m/V"],
  kg: [1e3, "g"],
  mg: [1e-3, "g"],
  F: [1, "F"],
  fF: [1e-15, "F"],
  Pa: [1, "Pa"],
  A: [1, "A"],
  W: [1, "W"],
  B: [1, "B"],
};

const PREFIXES: [number, string][] = [
  [1e12, "T"],
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
  [1e-15, "f"],
  [1e-18, "a"],
];

/** Numbers without a prefix are written out between these. */
const LEAST_PLAIN = 1e-3;
const MOST_PLAIN = 1e6;

/**
 * The scale on which `magnitude` (the largest value to be shown) reads as 1 to 999 of a prefixed unit.
 *
 * Chosen once per axis, so that a value passing through zero does not change its unit.
 */
export function unitScale(unit: string, magnitude: number, digits = 4): UnitScale {
  const base = UNITS[unit];
  const [toBase, name] = base ?? [1, unitText(unit)];
  const size = roundTo(Math.abs(magnitude) * toBase, digits); // what rounds up to 1000 takes the next prefix
  const [scale, prefix] = base ? prefixOf(size, toBase) : [isPlain(size) ? 1 : undefined, ""];
  if (scale !== undefined)
    return { factor: toBase / scale, unit: prefix + name, decimals: decimalsFor(size / scale, digits), exponent: "" };
  const power = 3 * Math.floor(powerOf(size) / 3);
  return {
    factor: toBase / 10 ** power,
    unit: name,
    decimals: decimalsFor(size / 10 ** power, digits),
    exponent: power === 0 ? "" : `×10${raised(power)}`,
  };
}

/**
 * The unit in which several figures read without a power of ten, and the factor to it: their own unit if possible,
 * else the same unit with a prefix.
 */
export function plainScale(unit: string, values: readonly number[]): Pick<UnitScale, "factor" | "unit"> {
  const sizes = values.filter(Number.isFinite).map(Math.abs);
  if (!(unit in UNITS) || sizes.every(isPlain)) return { factor: 1, unit: unitText(unit) };
  return unitScale(unit, Math.max(...sizes));
}

export const isPlain = (size: number) => size === 0 || (size >= LEAST_PLAIN && size < MOST_PLAIN);

/** The prefix on which a size reads as 1 to 999, if there is one; zero keeps the unit it came in. */
function prefixOf(size: number, toBase: number): [number | undefined, string] {
  const wanted = size === 0 ? toBase : size;
  const found = PREFIXES.find(([scale]) => wanted >= scale);
  return found && wanted < 1e3 * PREFIXES[0][0] ? found : [undefined, ""];
}

/** Decimals that show a size in so many significant digits. */
export function decimalsFor(shown: number, digits: number): number {
  if (!(shown > 0)) return digits - 1;
  return Math.max(0, digits - 1 - powerOf(roundTo(shown, digits)));
}

const raised = (power: number) =>
  [...String(power)].map((one) => (one === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(one)])).join("");

const powerOf = (size: number) => Number(size.toExponential().split("e")[1]);

/** A value in so many significant digits, as a number. */
export function roundTo(value: number, digits: number): number {
  return Number(value.toPrecision(digits));
}

/** Numbers without a unit, and vectors whose components differ in theirs. */
const BARE = ["", "1", "mixed"];

/** A unit the way people write it. */
export function unitText(unit: string): string {
  if (BARE.includes(unit)) return "";
  return unit
    .replaceAll("rt h", "√h")
    .replaceAll("rtHz", "√Hz")
    .replace(/\bu(?=[A-Za-z])/g, "µ")
    .replace(/[* ]/g, "·")
    .replaceAll("^2", "²")
    .replaceAll("^3", "³");
}
