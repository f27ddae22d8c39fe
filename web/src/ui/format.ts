import { type UnitScale, unitScale } from "./unit-scale";

const MINUS = "−";
const THIN = "\u2009";

/** A number with fixed decimals, a real minus sign and grouped thousands. */
export function formatNumber(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return "–";
  const text = Math.abs(value).toFixed(decimals);
  const [whole, fraction] = text.split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  const sign = value < 0 && Number(text) !== 0 ? MINUS : "";
  return sign + grouped + (fraction ? `.${fraction}` : "");
}

/** A value on a scale chosen beforehand; its width does not jump. */
export function formatOn(scale: UnitScale, value: number): string {
  return formatNumber(value * scale.factor, scale.decimals);
}

/** A value with an SI-prefixed unit, for text that stands still. */
export function formatSi(value: number, unit: string, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  if (tiny(value, unit))
    return `${value.toExponential(digits - 1).replace("-", MINUS)}${unit ? THIN + unitScale(unit, 1).unit : ""}`;
  const scale = unitScale(unit, value, digits);
  return formatOn(scale, value) + (scale.unit ? `\u00a0${scale.unit}` : "");
}

/** Dimensionless numbers have no prefix to take: far from 1 they need a power of ten. */
function tiny(value: number, unit: string): boolean {
  const size = Math.abs(value);
  return (unit === "" || unit === "1") && size > 0 && (size < 1e-3 || size >= 1e6);
}

/** A share as a percentage. */
export function formatPercent(share: number, decimals = 1): string {
  return Number.isFinite(share) ? `${formatNumber(share * 100, decimals)}\u00a0%` : "–";
}
