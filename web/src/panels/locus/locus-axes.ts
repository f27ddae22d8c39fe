import { extent, follow, type Range } from "../phase/phase-range";

export interface Points {
  x: Float32Array;
  y: Float32Array;
}

export interface LocusAxes {
  x: Range;
  y: Range;
}

/** Axes about the rest that hold every trace; on one scale, or y stretched to its own. */
export function locusAxes(before: LocusAxes | undefined, traces: readonly Points[], stretched: boolean): LocusAxes {
  const reach = (axis: "x" | "y") =>
    Math.max(1e-9, ...traces.map((t) => Math.max(...(extent(t[axis]) ?? [0, 0]).map(Math.abs))));
  const across = reach("x");
  const up = reach("y");
  const about = (most: number): Range => [-most, most];
  const x = stretched ? across : Math.max(across, up);
  return { x: follow(before?.x, about(x)), y: follow(before?.y, about(stretched ? up : x)) };
}
