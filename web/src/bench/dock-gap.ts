import type { SerializedDockview } from "dockview-react";

type Node = SerializedDockview["grid"]["root"];

/** Between panels, px. */
export const DOCK_GAP = 6;

/**
 * A stored layout with the gaps put back into its sizes.
 *
 * The dock writes what a panel has left of its share after the gaps and reads it as the share itself, so that without
 * this each time the page is opened the panels give a pixel to the last one beside them.
 */
export function withGaps(stored: SerializedDockview): SerializedDockview {
  return { ...stored, grid: { ...stored.grid, root: padded(stored.grid.root) } };
}

function padded(node: Node): Node {
  if (!Array.isArray(node.data)) return node;
  const share = (DOCK_GAP * (node.data.length - 1)) / node.data.length;
  return { ...node, data: node.data.map((child) => padded({ ...child, size: (child.size ?? 0) + share })) };
}
