import { expect, it } from "vitest";
import { deviation, driftGrade, scatter, TERMS, valuesOf, walkGrade } from "./deviation";

it("has the slopes of IEEE Std 952, and its units", () => {
  expect(TERMS.N(0.1, 3600)).toBeCloseTo(0.1); // over an hour
  expect(TERMS.N(0.1, 36)).toBeCloseTo(1);
  expect(TERMS.B(3, 1)).toBeCloseTo(0.6643 * 3, 3);
  expect(TERMS.K(10, 3 * 3600)).toBeCloseTo(10);
  expect(TERMS.K(10, 0.03 * 3600)).toBeCloseTo(1);
  expect(deviation({ N: 0.1, K: 10 }, 36)).toBeCloseTo(Math.hypot(1, TERMS.K(10, 36)));
});

it("trusts a deviation as far as its record goes", () => {
  expect(scatter(0, 50)).toBeCloseTo(0.1);
  // eight overlapping pairs say little more than one
  expect(scatter(5, 1)).toBeCloseTo(Math.SQRT1_2);
  expect(scatter(5, 9)).toBeCloseTo(0.5);
});

it("takes the figures there are", () => {
  const figure = { name: "", unit: "", error: null, reason: "" };
  const figures = [
    { ...figure, letter: "N", value: 0.11, true: 0.1 },
    { ...figure, letter: "B", value: null, true: 3 },
    { ...figure, letter: "K", value: null, true: 0 },
  ];
  expect(valuesOf(figures, "value")).toEqual({ N: 0.11 });
  expect(valuesOf(figures, "true")).toEqual({ N: 0.1, B: 3 });
});

it("grades an angle random walk", () =>
  expect([0.6, 0.5, 0.05, 0.01, 0.0005].map(walkGrade)).toEqual([
    "rate grade",
    "tactical grade",
    "tactical grade",
    "between tactical and inertial grade",
    "inertial grade",
  ]));

it("grades a bias instability", () =>
  expect([2000, 100, 10, 0.01, 0.005].map(driftGrade)).toEqual([
    "below rate grade",
    "rate grade",
    "tactical grade",
    "tactical grade",
    "inertial grade",
  ]));
