import { extent, follow, type Range } from "../phase/phase-range";

export interface Points {
  x: Float32Array;
  y: Float32Array;
}

export interface LocusAxes {
  x: Range;
  y: Range;
}

/** Axes about zero that hold every trace; on one scale, or y stretched to its own. */
export function locusAxes(before: LocusAxes | undefined, traces: readonly Points[], stretched: boolean): LocusAxes {
  const reach = (axis: "x" | "y") =>
    Math.max(1e-9, ...traces.map((t) => Math.max(...(extent(t[axis]) ?? [0, 0]).map(Math.abs))));
  const across = reach("x");
  const up = reach("y");
  const about = (most: number): Range => [-most, most];
  const x = stretched ? across : Math.max(across, up);
  return { x: follow(before?.x, about(x)), y: follow(before?.y, about(stretched ? up : x)) };
}

/**
 * The long axis of a locus against x, in degrees from -90 to 90: the axis of the largest scatter,
 * tan 2a = 2 cov(x, y) / (var x - var y). Undefined when nothing moves.
 */
export function tiltDeg(x: ArrayLike<number>, y: ArrayLike<number>): number | undefined {
  const sums = { n: 0, x: 0, y: 0 };
  for (let i = 0; i < x.length; i += 1) {
    if (!Number.isFinite(x[i] + y[i])) continue;
    sums.n += 1;
    sums.x += x[i];
    sums.y += y[i];
  }
  if (sums.n < 3) return undefined;
  let xx = 0;
  let xy = 0;
  let yy = 0;
  for (let i = 0; i < x.length; i += 1) {
    if (!Number.isFinite(x[i] + y[i])) continue;
    const dx = x[i] - sums.x / sums.n;
    const dy = y[i] - sums.y / sums.n;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  if (xx + yy === 0) return undefined;
  return (90 / Math.PI) * Math.atan2(2 * xy, xx - yy);
}
