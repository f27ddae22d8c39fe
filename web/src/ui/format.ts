import { decimalsFor, isPlain, roundTo, type UnitScale, unitScale, unitText } from "./unit-scale";

// Every number the page writes for people is written here. `core/format.py` does the same for reports, pictures and
// logs; `testing/cases/format.json` holds both to one text for one value.

const MINUS = "−";
const THIN = "\u202f";
const SPACE = "\u00a0";
const NOTHING = "–";
const PLUS_MINUS = `${SPACE}±${SPACE}`;
/** Digits of a whole figure with a unit. */
const WHOLE_DIGITS = 9;
/** From here on a number with fixed decimals would be a row of digits that mean nothing. */
const IMMENSE = 1e15;

/** A number with fixed decimals, a real minus sign and grouped thousands. */
export function formatNumber(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return NOTHING;
  if (Math.abs(value) >= IMMENSE) return formatSi(value, "");
  const text = Math.abs(value).toFixed(decimals);
  const [whole, fraction] = text.split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  const sign = value < 0 && Number(text) !== 0 ? MINUS : "";
  return sign + grouped + (fraction ? `.${fraction}` : "");
}

/** A value with an SI-prefixed unit and all its significant digits, for figures that are measured. */
export function formatSi(value: number, unit: string, digits = 4): string {
  if (!Number.isFinite(value)) return NOTHING;
  return formatOn(unitScale(unit, value, digits), value);
}

/** A value with an SI-prefixed unit in as few digits as it needs, for figures that were chosen: "200 µs", "1.5 ms". */
export function formatShort(value: number, unit: string, digits = 4): string {
  if (!Number.isFinite(value)) return NOTHING;
  const scale = unitScale(unit, value, digits);
  const shown = Number((value * scale.factor).toFixed(scale.decimals));
  return formatOn({ ...scale, decimals: decimalsOf(shown, scale.decimals) }, value);
}

/** A value on a scale chosen beforehand; its width does not jump. */
export function formatOn(scale: UnitScale, value: number): string {
  if (!Number.isFinite(value)) return NOTHING;
  return withUnit(formatNumber(value * scale.factor, scale.decimals) + scale.exponent, scale.unit);
}

/** A value in its own unit with fixed decimals, for columns and for units that take no prefix. */
export function formatIn(value: number, unit: string, decimals: number): string {
  return Number.isFinite(value) ? withUnit(formatNumber(value, decimals), unitText(unit)) : NOTHING;
}

/** A share as a percentage; one close to 0 or 100 % keeps the digits that tell it from them. */
export function formatPercent(share: number, decimals = 1): string {
  return formatPart(share * 100, 100, "%", decimals);
}

/** A share as a part of 1, distinguished from 0 and 1 in the same way. */
export function formatShare(share: number, decimals = 4): string {
  return formatPart(share, 1, "", decimals);
}

/** A measured figure by the name of its metric, a missing one as a dash; a whole figure, such as a count, has no decimals. */
export function formatFigure(metric: string, value: number | null | undefined, digits = 4, unit = ""): string {
  if (value === null || value === undefined) return NOTHING;
  if (metric.endsWith("_fraction")) return formatShare(value, digits);
  if (!Number.isInteger(value)) return formatSi(value, unit, digits);
  return unit ? formatShort(value, unit, WHOLE_DIGITS) : formatNumber(value, 0);
}

/**
 * A mean and its standard deviation, to the second digit of the deviation, in one unit with one prefix:
 * "709.00 ± 0.70 nm". No line breaks inside it.
 */
export function formatSpread(metric: string, mean: number, std: number, unit = ""): string {
  const scale = unitScale(unit, Math.max(Math.abs(mean), std));
  if (std === 0) {
    const figure = scale.exponent || scale.factor !== 1 ? "" : formatFigure(metric, mean);
    return pair(figure || formatNumber(mean * scale.factor, scale.decimals), "0", scale);
  }
  const [shown, spread] = [mean * scale.factor, std * scale.factor];
  const decimals = Math.min(decimalsFor(spread, 2), decimalsFor(Math.max(Math.abs(shown), spread), 6));
  return pair(formatNumber(shown, decimals), formatLeast(spread, decimals), scale);
}

/** A value and its error, with the power of ten and the unit of both. */
function pair(value: string, spread: string, { exponent, unit }: UnitScale): string {
  const both = `${value}${PLUS_MINUS}${spread}`;
  return withUnit(exponent ? `(${both})${exponent}` : both, unit);
}

/** A difference from a figure, or its deviation, with the decimals that the figure has. */
export function formatBeside(value: number, figure: number, digits: number): string {
  if (value === 0 || (Number.isInteger(value) && Number.isInteger(figure))) return formatNumber(value, 0);
  if (!isPlain(Math.abs(figure))) return formatSi(value, "", 3);
  return formatLeast(value, decimalsFor(Math.abs(figure), digits));
}

/** A number that is not zero and would read as zero gets a bound. */
function formatLeast(value: number, decimals: number): string {
  const isLess = value !== 0 && Number(value.toFixed(decimals)) === 0;
  return isLess ? `<${SPACE}${formatNumber(10 ** -decimals, decimals)}` : formatNumber(value, decimals);
}

/** A part of a whole; a part that would read as none or all of it gets up to two more decimals, then a bound. */
export function formatPart(part: number, whole: number, unit: string, decimals: number): string {
  const ends = [0, whole];
  const most = decimals + 2;
  for (let kept = decimals; kept <= most; kept += 1)
    if (ends.includes(part) || !ends.includes(Number(part.toFixed(kept)))) return formatIn(part, unit, kept);
  if (part < 0 || part > whole || Number.isNaN(part)) return formatIn(part, unit, decimals);
  const least = 10 ** -most;
  return part < whole / 2
    ? `<${SPACE}${formatIn(least, unit, most)}`
    : `>${SPACE}${formatIn(whole - least, unit, most)}`;
}

/** A change, with its sign. */
export function formatChange(change: number, unit: string, decimals: number): string {
  const text = formatIn(change, unit, decimals);
  return change > 0 && Number(change.toFixed(decimals)) !== 0 ? `+${text}` : text;
}

/** How many of something: "1 sample", "4096 ticks". */
export function formatCount(count: number, noun: string): string {
  return withUnit(formatNumber(count, 0), Math.abs(count) === 1 ? noun : `${noun}s`);
}

/** A moment of device time, to the microsecond: it names a tick. */
export function formatMoment(ms: number): string {
  return formatIn(ms, "ms", 3);
}

/** The name of a tick. */
export function formatTick(tick: number): string {
  return `tick${SPACE}${formatNumber(tick, 0)}`;
}

/** Device time as a clock shows it, in seconds: to the microsecond, of fixed width. */
export function formatClock(ms: number): string {
  const text = formatNumber(ms / 1000, 6);
  return text === NOTHING ? text : `${text.slice(0, -3)}${THIN}${text.slice(-3)}`;
}

/** Labels of the ticks of an axis: as many decimals as its steps need, and no more. */
export function tickLabels(ticks: readonly number[]): string[] {
  return labelsOn(unitScale("", Math.max(0, ...ticks.map(Math.abs))), ticks);
}

/** Labels of the ticks of an axis whose title says the unit of its scale. */
export function labelsOn(
  { factor, exponent }: Pick<UnitScale, "factor" | "exponent">,
  ticks: readonly number[],
): string[] {
  const shown = ticks.map((tick) => roundTo(tick * factor, 12));
  const decimals = Math.max(0, ...shown.map((tick) => decimalsOf(tick, 9)));
  return shown.map((tick) => formatNumber(tick, decimals) + (tick === 0 ? "" : exponent));
}

/** A number and the unit after it. */
const WITH_UNIT = /(\d) (?=(?:%|°C?|dB|[kMGmuµnpf]?(?:m|s|V|N|g|K|A|W|F|Pa|Hz|rad|Ω|min|h))(?![\p{L}\d]))/gu;

/** A sentence that no line break parts between a number and its unit. */
export const keepUnits = (text: string): string => text.replace(WITH_UNIT, `$1${SPACE}`);

/** A text of this file inside an equation. */
export function inTex(text: string): string {
  return text
    .replaceAll(MINUS, "-")
    .replaceAll(THIN, "\\,")
    .replaceAll(SPACE, "~")
    .replace(/×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)$/, (_, power: string) => `\\cdot10^{${[...power].map(lowered).join("")}}`);
}

const lowered = (digit: string) => (digit === "⁻" ? "-" : String("⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(digit)));

/** A number as one would type it, for fields that are edited: without grouping, with the hyphen of the keyboard. */
export function formatEntry(value: number): string {
  const rounded = roundTo(value, 8);
  return Math.abs(rounded) < 1e-3 && rounded !== 0 ? rounded.toExponential() : String(rounded);
}

/** Fewest decimals, at most `most`, that show a value as it is. */
function decimalsOf(value: number, most: number): number {
  const full = Number(value.toFixed(most));
  let decimals = 0;
  while (decimals < most && Number(value.toFixed(decimals)) !== full) decimals += 1;
  return decimals;
}

function withUnit(text: string, unit: string): string {
  if (unit === "") return text;
  return unit === "°" ? text + unit : text + SPACE + unit;
}
