import type { Bench, BlockCard } from "./types";

/** Whether a block suits a bench whose plant moves along these axes; no axes mean one displacement. */
export function fits({ axes, per_axis }: Pick<BlockCard, "axes" | "per_axis">, ofBench: readonly string[]): boolean {
  if (axes === null || per_axis) return !per_axis || ofBench.length > 0;
  return axes.length === 0 ? ofBench.length === 0 : axes.every((axis) => ofBench.includes(axis));
}

/** The controllers of a slot, in the order of the catalogue. */
export function controllersOf<T extends Pick<BlockCard, "family" | "name" | "slot">>(
  slot: string,
  controllers: readonly string[],
  blocks: readonly T[],
): T[] {
  return blocks.filter((b) => b.family === "control" && b.slot === slot && controllers.includes(b.name));
}

/** Whether a bench has a plant with axes. */
export const hasAxes = (bench: Pick<Bench, "axes"> | undefined): boolean => (bench?.axes.length ?? 0) > 0;
