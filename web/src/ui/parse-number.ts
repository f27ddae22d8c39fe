import { formatShort } from "./format";
import { roundTo } from "./unit-scale";

interface Limits {
  minimum: number | null;
  maximum: number | null;
  integer: boolean;
}

/** A typed number, or in words what is wrong with it. */
export function parseNumber(text: string, { minimum, maximum, integer }: Limits): number | string {
  const value = Number(text.trim().replace(",", ".").replace("−", "-"));
  if (text.trim() === "" || !Number.isFinite(value)) return "not a number";
  if (integer && !Number.isInteger(value)) return "whole numbers only";
  if (minimum !== null && value < minimum) return `at least ${formatShort(minimum, "", 6)}`;
  if (maximum !== null && value > maximum) return `at most ${formatShort(maximum, "", 6)}`;
  return value;
}

/** The next value up or down: one unit of the second digit. */
export function nudge(value: number, direction: 1 | -1, integer: boolean): number {
  if (!Number.isFinite(value)) return value;
  const power = value === 0 ? 0.1 : 10 ** (Math.floor(Math.log10(Math.abs(value))) - 1);
  const step = integer ? Math.max(1, Math.round(power)) : power;
  return roundTo(value + direction * step, 8);
}
