import { expect, it } from "vitest";
import { parameterTitle } from "./parameter-title";

it.each([
  ["process noise v", "V", "Process noise"],
  ["noise um", "um", "Noise"],
  ["stiffness n m", "N/m", "Stiffness"],
  ["humidity pct", "%", "Humidity"],
  ["deg per s", "deg/s", "Angular rate"],
  ["slew v per us", "V/us", "Slew"],
  ["probability floor", "1", "Probability floor"],
])("%s [%s] is %s", (label, unit, title) =>
  expect(parameterTitle({ label, unit, meaning: "angular rate" })).toBe(title));
