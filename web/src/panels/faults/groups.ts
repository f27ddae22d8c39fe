import type { BlockCard } from "../../api/types";

/** Where faults stand that name no group, such as those of other packages. */
const OTHERS = "Others";

/** Blocks under their headings; groups and members come in the order of the catalogue. */
export function groupsOf<T extends Pick<BlockCard, "group">>(blocks: readonly T[]): [string, T[]][] {
  const groups = new Map<string, T[]>();
  for (const block of blocks) {
    const group = block.group || OTHERS;
    groups.set(group, [...(groups.get(group) ?? []), block]);
  }
  return [...groups];
}
