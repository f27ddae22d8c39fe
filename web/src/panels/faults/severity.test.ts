import { expect, it } from "vitest";
import type { Parameter } from "../../api/types";
import { severityScale, severityText } from "./severity";

const scale = { percent: false, low: 0, high: 1, minimum: 0, maximum: 1 };

it("writes severities with their sign and unit as people do", () => {
  expect(severityText(0.05, { ...scale, percent: true }, "1")).toBe("+5\u00a0%");
  expect(severityText(0.5, scale, "um")).toBe("+500\u00a0nm");
  expect(severityText(4, scale, "week")).toBe("+4\u00a0weeks");
  expect(severityText(1, scale, "week")).toBe("+1\u00a0week");
});

it("takes a severity with a unit for what it is, and one without for a share", () => {
  const parameter = (unit: string) => ({ unit, minimum: -1e5, maximum: 1e5 }) as Parameter;
  const shock = severityScale(parameter("g"), 20);
  expect(severityText(20, shock, "g")).toBe("+20\u00a0g");
  expect([shock.low, shock.high]).toEqual([-200, 200]);
  expect(severityScale(parameter("1"), 0.05).percent).toBe(true);
});
