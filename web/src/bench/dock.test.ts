// @vitest-environment jsdom
import { Orientation, type SerializedDockview } from "dockview-react";
import { expect, it } from "vitest";
import { withGaps } from "./dock";

const leaf = (id: string, size: number) => ({ type: "leaf" as const, size, data: { id, views: [id] } });

it("makes the sizes of a stored layout fill the dock they were stored from", () => {
  const root = {
    type: "branch" as const,
    size: 796,
    data: [
      { type: "branch" as const, size: 353, data: [leaf("1", 268), leaf("2", 522)] },
      { type: "branch" as const, size: 1009, data: [leaf("3", 283), leaf("4", 171), leaf("5", 330)] },
    ],
  };
  const stored: SerializedDockview = {
    grid: { root, width: 1368, height: 796, orientation: Orientation.HORIZONTAL },
    panels: {},
  };
  const { grid } = withGaps(stored);
  const branches = grid.root.data as (typeof root)["data"];
  const sum = (nodes: { size: number }[]) => nodes.reduce((all, { size }) => all + size, 0);
  expect(sum(branches)).toBe(1368);
  for (const branch of branches) expect(sum(branch.data)).toBe(796);
  expect(branches[1].data.map((n) => n.size)).toEqual([287, 175, 334]);
  expect(root.data[0].size).toBe(353);
});
