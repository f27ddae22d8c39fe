import { roundTo } from "./unit-scale";

/** Round values across a range, about `count` of them. */
export function linearTicks(low: number, high: number, count: number): number[] {
  const raw = (high - low) / Math.max(1, count);
  if (!(raw > 0)) return [];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = ([1, 2, 5, 10].find((m) => m * power >= raw * 0.999) ?? 10) * power;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => roundTo((first + i) * step, 12));
}

/** 1, 2 and 5 of every decade within a range. */
export function decadeTicks(low: number, high: number): number[] {
  const found: number[] = [];
  for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; power += 1)
    for (const m of [1, 2, 5]) {
      const tick = roundTo(m * 10 ** power, 3);
      if (tick >= low * 0.9999 && tick <= high * 1.0001) found.push(tick);
    }
  return found;
}

/** The powers of ten within a range. */
export function powerTicks(low: number, high: number): number[] {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => roundTo(10 ** (first + i), 6));
}
