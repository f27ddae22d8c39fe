import { expect, it } from "vitest";
import type { Parameter } from "../api/types";
import { severityScale, severityText } from "./severity";

const scale = { percent: false, low: 0, high: 1, minimum: 0, maximum: 1, step: 0.1 };

it("writes severities with their sign and unit as people do", () => {
  expect(severityText(0.05, { ...scale, percent: true }, "1")).toBe("+5\u00a0%");
  expect(severityText(0.5, scale, "um")).toBe("+500\u00a0nm");
  expect(severityText(4, scale, "week")).toBe("+4\u00a0weeks");
  expect(severityText(4.3, scale, "week")).toBe("+4.3\u00a0weeks");
  expect(severityText(1, scale, "week")).toBe("+1\u00a0week");
});

it("takes a severity with a unit for what it is, and one without for a share", () => {
  const parameter = (unit: string) => ({ unit, minimum: -1e5, maximum: 1e5 }) as Parameter;
  const shock = severityScale(parameter("g"), 20);
  expect(severityText(20, shock, "g")).toBe("+20\u00a0g");
  expect([shock.low, shock.high]).toEqual([-200, 200]);
  expect(severityScale(parameter("1"), 0.05).percent).toBe(true);
});

it("steps by what the slider shows, by whole numbers where there is nothing between", () => {
  const parameter = (unit: string, maximum: number) => ({ unit, minimum: 0, maximum }) as Parameter;
  expect(severityScale(parameter("1", 20), 0.05).step).toBe(1);
  expect(severityScale(parameter("um", 20), 0.1).step).toBe(0.1);
  expect(severityScale(parameter("pair", 100), 1).step).toBe(1);
});
