import { expect, it } from "vitest";
import { overridden, slotTitle } from "./slots";

const port = (name: string, unit = "uN") => ({ name, unit, meaning: "", source: "", labels: [], each: "" });
const CARDS: Record<string, { title: string; outputs: ReturnType<typeof port>[] }> = {
  drive_loop: { title: "Drive loop", outputs: [port("x"), port("amplitude", "um")] },
  rebalance: { title: "Force to rebalance", outputs: [port("rate", "deg/s"), port("y")] },
  whole_angle: { title: "Whole angle", outputs: [port("x"), port("y"), port("rate", "deg/s")] },
};
const block = (_: string, name: string) => CARDS[name];

it("names a slot", () => {
  expect(["", "drive", "sense"].map(slotTitle)).toEqual(["Controller", "Drive controller", "Sense controller"]);
});

it("says when a later slot drives the axis of an earlier one", () => {
  expect(overridden("drive", { drive: "drive_loop", sense: "whole_angle" }, block)?.title).toBe("Whole angle");
  expect(overridden("drive", { drive: "drive_loop", sense: "rebalance" }, block)).toBeUndefined();
  expect(overridden("sense", { drive: "drive_loop", sense: "whole_angle" }, block)).toBeUndefined();
});
