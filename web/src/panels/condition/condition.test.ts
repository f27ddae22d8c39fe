import { expect, it } from "vitest";
import { conditionText, conditionWords, signalGroups } from "./condition";

const SIGNALS = [
  { name: "plant.displacement", unit: "um" },
  { name: "plant.velocity", unit: "um/ms" },
  { name: "kalman.probability.m+5", unit: "1" },
];

it("is written as the server takes it", () => {
  expect(conditionText({ signal: "plant.displacement", above: true, level: 2 })).toBe("plant.displacement > 2");
  expect(conditionText({ signal: "plant.velocity", above: false, level: -0.5 })).toBe("plant.velocity < -0.5");
});

it("is read in words, with the unit of its signal", () => {
  expect(conditionWords("plant.displacement > 0.25", SIGNALS)).toBe("plant displacement > 250\u00a0nm");
  expect(conditionWords("kalman.probability.m+5 < 1e-3", SIGNALS)).toBe("kalman probability m+5 < 0.001");
  expect(conditionWords("gone.signal > 2", SIGNALS)).toBe("gone signal > 2");
  expect(conditionWords("something else", SIGNALS)).toBe("something else");
});

it("offers the signals block by block", () => {
  expect(signalGroups(SIGNALS)).toEqual([
    {
      group: "plant",
      items: [
        { value: "plant.displacement", label: "plant displacement" },
        { value: "plant.velocity", label: "plant velocity" },
      ],
    },
    { group: "kalman", items: [{ value: "kalman.probability.m+5", label: "kalman probability m+5" }] },
  ]);
});
