import { expect, it } from "vitest";
import { scopeConfig } from "../../stream/scope-config";
import { scopeSubscription, zoomSpan } from "./use-time-view";

const config = scopeConfig(["a"], { windowMs: 4 });

it("asks for as many columns as there are pixels, but not more than there are ticks", () => {
  expect(scopeSubscription(config, { kind: "live" }, 800, 0.001)).toEqual({
    mode: "roll",
    signals: ["a"],
    window_ms: 4,
    width: 800,
  });
  expect(scopeSubscription(config, { kind: "live" }, 800, 0.02)).toMatchObject({ width: 200 });
});

it("freezes whole ticks of the past", () => {
  expect(scopeSubscription(config, { kind: "past", start: 10.4, end: 20.2 }, 800, 0.02)).toEqual({
    mode: "frozen",
    signals: ["a"],
    start_tick: 10,
    end_tick: 21,
    width: 11,
  });
});

it("hands the trigger to the server", () => {
  const triggered = scopeSubscription({ ...config, mode: "triggered" }, { kind: "live" }, 100, 0.02);
  expect(triggered).toMatchObject({ mode: "triggered", trigger: { edge: "rising", sweep: "auto" } });
});

it("zooms about the tick under the pointer and never below a few ticks", () => {
  const half = zoomSpan(0, 100, 25, 0.5);
  expect(half).toEqual({ start: 12.5, end: 62.5 });
  const least = zoomSpan(0, 10, 5, 0.01);
  expect(least.end - least.start).toBe(8);
});
