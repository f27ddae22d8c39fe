import { expect, it } from "vitest";
import { boxOf, faultLines } from "./loop";

it("shows a fault on the sensor, on the drive, or on the device", () => {
  expect(["sensor", "drive", "beams", "frame", null].map(boxOf)).toEqual([
    "sensor",
    "drive",
    "plant",
    "plant",
    "plant",
  ]);
});

it("names as many faults as there is room for, and counts the rest", () => {
  expect(faultLines(["Added mass", "Damping"])).toEqual(["Added mass", "Damping"]);
  expect(faultLines(["a", "b", "c", "d"])).toHaveLength(4);
  expect(faultLines(["a", "b", "c", "d", "e", "f"])).toEqual(["a", "b", "c", "and 3 more"]);
});
