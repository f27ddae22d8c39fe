import { formatShort, formatSi } from "../ui/format";
import { roundTo } from "../ui/unit-scale";

const SLOWEST = 1e-6;
const FASTEST = 1;

/** The buttons of the menu of time scales. */
export const PRESETS: readonly (number | null)[] = [0.002, FASTEST, null];

/** Multiples of the pace a recording was made at. */
export const REPLAY_SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];

/** A time scale to choose: "2 ms/s", "Real time". */
export function presetLabel(scale: number | null): string {
  if (scale === null) return "As fast as possible";
  return scale === FASTEST ? "Real time" : formatShort(scale, "s/s");
}

/** Marks of the slider of time scales: its ends and its middle. */
export const scaleMarks = () =>
  [0, 0.5, 1].map((value) => ({ value, label: presetLabel(sliderToTimeScale(value)).toLowerCase() }));

export const speedItems = () =>
  REPLAY_SPEEDS.map((speed) => ({ value: String(speed), label: formatShort(speed, "×") }));

/** Device time per wall time in words: "2.00 ms/s". */
export function formatTimeScale(scale: number | null): string {
  if (scale === null) return "as fast as possible";
  return formatSi(scale, "s/s", 3);
}

/** A time scale against real time: "500 × slower than real time". */
export function againstRealTime(scale: number | null): string {
  if (scale === null) return "as fast as the machine can";
  if (scale === FASTEST) return "real time";
  return scale < FASTEST
    ? `${formatShort(FASTEST / scale, "×", 3)} slower than real time`
    : `${formatShort(scale, "×", 3)} faster than real time`;
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
  return Math.min(FASTEST, Math.max(SLOWEST, roundTo(mantissa * power, 3)));
}
