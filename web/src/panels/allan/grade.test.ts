import { expect, it } from "vitest";
import { driftGrade, walkGrade } from "./grade";

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
