import { describe, expect, it } from "vitest";
import { formatNumber, formatOn, formatPercent, formatSi } from "./format";
import { unitScale, unitText } from "./unit-scale";

describe("formatSi", () => {
  it.each([
    [0.0032, "um", "3.200\u00a0nm"],
    [3.2071, "um", "3.207\u00a0µm"],
    [1234, "um", "1.234\u00a0mm"],
    [-12.5, "V", "−12.50\u00a0V"],
    [0.01, "V", "10.00\u00a0mV"],
    [2.209e-10, "kg", "220.9\u00a0ng"],
    [2000, "Hz", "2.000\u00a0kHz"],
    [0.74, "ms", "740.0\u00a0µs"],
    [0, "um", "0.000\u00a0µm"],
    [0.99999999, "ms", "1.000\u00a0ms"],
    [5, "1", "5.000"],
    [1e-5, "", "1.000e−5"],
  ])("%s %s", (value, unit, text) => expect(formatSi(value, unit)).toBe(text));

  it("shows missing values as a dash", () => expect(formatSi(Number.NaN, "V")).toBe("–"));
});

describe("formatOn", () => {
  it("keeps unit and decimals of the axis, so a value through zero does not jump", () => {
    const scale = unitScale("um", 4.1);
    expect(scale.unit).toBe("µm");
    expect([4.1, 0.003, -0.003, 0].map((v) => formatOn(scale, v))).toEqual(["4.100", "0.003", "−0.003", "0.000"]);
  });

  it("never writes minus zero", () => expect(formatNumber(-0.0001, 2)).toBe("0.00"));

  it("groups thousands", () => expect(formatNumber(1234567.8, 1)).toBe("1\u2009234\u2009567.8"));
});

it("writes units as people do", () => {
  expect(unitText("um/ms")).toBe("µm/ms");
  expect(unitText("uN")).toBe("µN");
  expect(unitText("1")).toBe("");
});

it("writes shares as percentages", () => expect(formatPercent(0.9823)).toBe("98.2\u00a0%"));
