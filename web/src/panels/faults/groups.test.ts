import { expect, it } from "vitest";
import { groupsOf } from "./groups";

it("keeps the order of the catalogue, and those without a group under a heading of theirs", () => {
  const fault = (name: string, group: string) => ({ name, group });
  const found = groupsOf([
    fault("mass", "The usual"),
    fault("noise", "Measurement"),
    fault("k", "The usual"),
    fault("mine", ""),
  ]);
  expect(found.map(([group, members]) => [group, ...members.map((f) => f.name)])).toEqual([
    ["The usual", "mass", "k"],
    ["Measurement", "noise"],
    ["Others", "mine"],
  ]);
});
