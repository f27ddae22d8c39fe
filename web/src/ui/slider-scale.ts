import { roundTo } from "./unit-scale";

export interface SliderScale {
  low: number;
  high: number;
  log: boolean;
}

/** Place of a value on a slider from 0 to 1; beyond its ends it stays at them. */
export function positionOf(value: number, { low, high, log }: SliderScale): number {
  const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.min(1, Math.max(0, Number.isFinite(share) ? share : 0));
}

/** Value at a place, on steps; on a logarithmic scale in three digits. */
export function valueAt(position: number, { low, high, log }: SliderScale, step: number): number {
  const value = log ? low * (high / low) ** position : low + (high - low) * position;
  return step > 0 ? roundTo(Math.round(value / step) * step, 8) : roundTo(value, 3);
}
