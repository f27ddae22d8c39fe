import { formatNumber } from "../ui/format";
import { unitScale } from "../ui/unit-scale";

export const SLOWEST = 1e-6;
export const FASTEST = 1;

/** Device time per wall time in words: "2.00 ms/s". */
export function formatTimeScale(scale: number | null): string {
  if (scale === null) return "as fast as possible";
  const shown = unitScale("s", scale, 3);
  return `${formatNumber(scale * shown.factor, shown.decimals)}\u00a0${shown.unit}/s`;
}

/** Twice or half as fast, staying on the slider. */
export function stepTimeScale(scale: number | null, factor: number): number | null {
  const next = (scale ?? FASTEST) * (scale === null && factor > 1 ? 1 : factor);
  return Math.min(FASTEST, Math.max(SLOWEST, next));
}

/** Slider position 0 ... 1 on a logarithmic scale. */
export function timeScaleToSlider(scale: number | null): number {
  return Math.log(((scale ?? FASTEST) as number) / SLOWEST) / Math.log(FASTEST / SLOWEST);
}

/** A round value (1, 2 or 5) for a slider position. */
export function sliderToTimeScale(position: number): number {
  const raw = SLOWEST * (FASTEST / SLOWEST) ** position;
  const power = 10 ** Math.floor(Math.log10(raw) + 1e-9);
  const mantissa = [1, 2, 5, 10].reduce(
    (best, m) => (Math.abs(Math.log(raw / power / m)) < Math.abs(Math.log(raw / power / best)) ? m : best),
    1,
  );
  return Math.min(FASTEST, Math.max(SLOWEST, Number((mantissa * power).toPrecision(3))));
}
