import { middles, type PanelFrame } from "../../stream/panel-frame";

/** Periods in the window of a figure, and ticks in it where the drive has no period. */
const PERIODS = 10;
const TICKS = 500;
/** The server sends no more samples of a signal at once; a figure takes two windows. */
const MOST = 2048;
/** Between one look at the figures and the next, in parts of the time since the change. */
const STEP = 1.15;
/** Settled: two windows in succession differ by no more than these shares of the later one, or of the figure before. */
const SHARE = 0.05;
const SHARE_BEFORE = 0.02;

/** The length of the window of a figure when `there` ticks exist: whole periods of the drive. */
export function windowTicks(period: number | null | undefined, there: number): number {
  const unit = unitOf(period);
  const most = Math.max(1, Math.min(period ? PERIODS : 1, Math.floor(MOST / unit)));
  return Math.round(Math.min(most, Math.floor(there / unit)) * unit);
}

const unitOf = (period: number | null | undefined): number => period || TICKS;

/** Up to how long after a change the figures are taken, in ticks: often at first, then ever less often. */
export function lookAt(elapsed: number, period: number | null | undefined): number {
  const unit = unitOf(period);
  if (elapsed < unit) return 0;
  const looks = Math.floor(Math.log(elapsed / unit) / Math.log(STEP));
  return Math.min(elapsed, Math.ceil(unit * STEP ** looks));
}

/** The root mean square of a signal over some of the samples of a frame. */
export function rms(frame: PanelFrame, signal: number, from = 0, until = frame.columns): number {
  let square = 0;
  for (const value of middles(frame, signal).subarray(from, until)) square += value * value;
  return Math.sqrt(square / (until - from));
}

/** The mean of a signal over some of the samples of a frame. */
export function mean(frame: PanelFrame, signal: number, from = 0): number {
  let sum = 0;
  for (const value of middles(frame, signal).subarray(from)) sum += value;
  return sum / (frame.columns - from);
}

/** Whether a figure has settled: two windows in succession agree, as closely as the figure before the change matters. */
export const hasSettled = (before: number, earlier: number, last: number): boolean =>
  Math.abs(last - earlier) <= Math.max(SHARE * last, SHARE_BEFORE * before);
