/** A vertical range that grows at once and shrinks only when it has been too wide for a while. */
export interface AxisRange {
  min: number;
  max: number;
  /** Since when the data would fit a much smaller range, in ms; undefined while they do not. */
  looseSince: number | undefined;
}

const LOOSE = 0.55;
const SHRINK_AFTER_MS = 1200;

export function nextRange(now: AxisRange | undefined, low: number, high: number, timeMs: number): AxisRange {
  if (!(low <= high)) return now ?? { min: -1, max: 1, looseSince: undefined };
  const fit = roundRange(low, high);
  if (!now) return { ...fit, looseSince: undefined };
  const grow = low < now.min || high > now.max;
  if (grow) return { min: Math.min(fit.min, now.min), max: Math.max(fit.max, now.max), looseSince: undefined };
  if (fit.max - fit.min > LOOSE * (now.max - now.min))
    return now.looseSince === undefined ? now : { ...now, looseSince: undefined };
  if (now.looseSince === undefined) return { ...now, looseSince: timeMs };
  return timeMs - now.looseSince >= SHRINK_AFTER_MS ? { ...fit, looseSince: undefined } : now;
}

/** Round a range outwards to a step of 1, 2 or 5, with a little air; a flat line gets room around it. */
export function roundRange(low: number, high: number): { min: number; max: number } {
  const middle = (low + high) / 2;
  const least = Math.max(Math.abs(middle) * 1e-3, 1e-12);
  const half = Math.max((high - low) / 2, high - low < least ? Math.max(Math.abs(middle) * 0.2, 1e-3) : 0) * 1.06;
  const step = niceStep(half / 16);
  return { min: Math.floor((middle - half) / step) * step, max: Math.ceil((middle + half) / step) * step };
}

function niceStep(raw: number): number {
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * ([1, 2, 5, 10].find((m) => m * power >= raw * 0.9999) ?? 10);
}
