import { expect, it } from "vitest";
import cases from "../testing/cases/axis.json";
import { labelsOn } from "./format";
import { decadeTicks, linearTicks } from "./ticks";
import { timeUnit } from "./time-axis";
import { unitScale } from "./unit-scale";

it.each(cases.linear as [number, number, number, number[]][])("puts round values from %s to %s, about %s", (...one) => {
  const [low, high, count, ticks] = one;
  expect(linearTicks(low, high, count)).toEqual(ticks);
});

it.each(cases.decade as [number, number, number[]][])("marks 1, 2 and 5 of every decade from %s to %s", (...one) => {
  const [low, high, ticks] = one;
  expect(decadeTicks(low, high)).toEqual(ticks);
});

it.each(cases.time as [number, string, number][])("shows a span of %s ms in %s", (span, unit, factor) =>
  expect(timeUnit(span)).toEqual({ unit, factor }));

it.each(cases.unit as [string, number, string, number][])("shows %s up to %s in %s", (unit, size, text, factor) => {
  const scale = unitScale(unit, size);
  expect([scale.unit, scale.factor]).toEqual([text, expect.closeTo(factor, 12)]);
});

it.each(cases.labels as [string, number[], string[]][])("labels %s ticks %s", (unit, ticks, labels) =>
  expect(labelsOn(unitScale(unit, Math.max(...ticks)), ticks)).toEqual(labels));
