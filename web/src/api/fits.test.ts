import { expect, it } from "vitest";
import { controllersOf, fits } from "./fits";

const card = (axes: string[] | null, per_axis = false) => ({ axes, per_axis });
const XY = ["x", "y"];
const PAIR = ["x", "y", "partner_x", "partner_y"];

it("puts a block on a bench by its axes", () => {
  expect([[], XY, PAIR].map((bench) => fits(card([]), bench))).toEqual([true, false, false]);
  expect([[], XY, PAIR].map((bench) => fits(card(XY), bench))).toEqual([false, true, true]);
  expect([[], XY, PAIR].map((bench) => fits(card(PAIR), bench))).toEqual([false, false, true]);
  expect([[], XY, PAIR].map((bench) => fits(card(null), bench))).toEqual([true, true, true]);
});

it("puts what stands at each axis on a bench that has some", () => {
  expect([[], XY].map((bench) => fits(card(null, true), bench))).toEqual([false, true]);
  expect([[], XY].map((bench) => fits(card([], true), bench))).toEqual([false, true]);
});

it("sorts controllers by their slot, in the order of the catalogue", () => {
  const law = (name: string, slot: string) => ({ family: "control", name, slot });
  const catalogue = [law("pid", ""), law("mrac", ""), law("drive_loop", "drive"), law("whole_angle", "sense")];
  const named = (slot: string, on: string[]) => controllersOf(slot, on, catalogue).map((b) => b.name);
  const all = ["drive_loop", "mrac", "pid", "whole_angle"];
  expect(["drive", "sense", ""].map((slot) => named(slot, all))).toEqual([
    ["drive_loop"],
    ["whole_angle"],
    ["pid", "mrac"],
  ]);
  expect(named("", ["mrac"])).toEqual(["mrac"]);
});
