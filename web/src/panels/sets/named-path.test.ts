import { expect, it } from "vitest";
import type { BlockCard } from "../../api/types";
import type { Instance } from "../card/instances";
import { namedPath, valueText } from "./named-path";

const SENSOR: Instance = {
  id: "sensor",
  title: "Sensor",
  family: "sense",
  name: "ideal",
  path: "sensor",
  also: ["sensors.ideal"],
};
const CARD = {
  title: "Ideal sensor",
  parameters: [{ name: "noise_um", label: "noise um", unit: "um", meaning: "standard deviation" }],
} as unknown as BlockCard;

it("names a parameter by its block and itself, wherever the document keeps it", () => {
  for (const path of ["sensor.noise_um", "sensors.ideal.noise_um"])
    expect(namedPath(path, [SENSOR], () => CARD)).toEqual({ block: "Ideal sensor", parameter: "Noise", unit: "um" });
});

it("says plainly what it does not know", () => {
  expect(namedPath("controllers.no_such.some_gain", [SENSOR], () => undefined)).toEqual({
    block: "controllers no such",
    parameter: "some gain",
    unit: "",
  });
});

it("writes values with their units", () => {
  expect(valueText(0.05, "um")).toBe("50\u00a0nm");
  expect([null, true, "square_wave", 2].map((v) => valueText(v, "1"))).toEqual([
    "from the bench",
    "yes",
    "square wave",
    "2",
  ]);
});
