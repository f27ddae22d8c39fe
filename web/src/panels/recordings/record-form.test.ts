// @vitest-environment jsdom
import { expect, it } from "vitest";
import { NEW_DRAFT, wantedOf } from "./record-form";

it("asks in ticks, at once, until it is stopped", () => {
  expect(wantedOf({ ...NEW_DRAFT, pastMs: 2.5 }, 0.01, undefined)).toEqual({
    name: "recording",
    past_ticks: 250,
    ticks: null,
    when: null,
    layout: null,
  });
});

it("waits for a condition and ends by itself", () => {
  const when = { signal: "plant.displacement", above: false, level: -3 };
  const draft = { name: " a ", pastMs: 0, lengthMs: 0.004, when };
  expect(wantedOf(draft, 0.01, { grid: 1 })).toEqual({
    name: "a",
    past_ticks: 0,
    ticks: 1,
    when: "plant.displacement < -3",
    layout: { grid: 1 },
  });
});
