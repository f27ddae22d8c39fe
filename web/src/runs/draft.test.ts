import { expect, it } from "vitest";
import { campaignOf, newDraft, parseValue, parseValues, pathsOf, pathTitle, pointCount, runOf } from "./draft";

it("reads numbers, truth, lists and words", () => {
  expect(["0.3", " −2e-3 ", "true", "[1, 2]", "mrac"].map(parseValue)).toEqual([0.3, -0.002, true, [1, 2], "mrac"]);
});

it("reads several values, and evenly spaced ones", () => {
  expect(parseValues("open_loop, mrac")).toEqual(["open_loop", "mrac"]);
  expect(parseValues("0:1:5, 3")).toEqual([0, 0.25, 0.5, 0.75, 1, 3]);
  expect(parseValues("0.1:0.4:4")).toEqual([0.1, 0.2, 0.3, 0.4]);
  expect(parseValues(" , ")).toEqual([]);
});

it("asks for seeds with both ends", () => {
  const draft = { ...newDraft("first-look"), firstSeed: 5, seeds: 3, set: [{ path: "sensor.noise_um", text: "0.1" }] };
  const asked = { scenario: "first-look", label: "", set: { "sensor.noise_um": 0.1 }, seeds: "5:7" };
  expect(runOf(draft)).toEqual({ ...asked, all: false });
  expect(runOf({ ...draft, all: true })).toEqual({ ...asked, all: true });
});

it("writes a grid, and counts its points times the devices", () => {
  const draft = {
    ...newDraft("ch5-seven-step"),
    seeds: 50,
    grid: [
      { path: "sensor.noise_um", text: "0.05, 0.6" },
      { path: "controller.kind", text: "open_loop, mrac, stvsc" },
      { path: "", text: "7" },
    ],
    devices: 4,
  };
  expect(pointCount(draft)).toBe(24);
  expect(campaignOf(draft)).toMatchObject({
    schema: 1,
    scenario: "ch5-seven-step",
    seeds: "1:50",
    grid: { "sensor.noise_um": [0.05, 0.6], "controller.kind": ["open_loop", "mrac", "stvsc"] },
    process_spread: { devices: 4 },
  });
  expect(campaignOf(draft)).not.toHaveProperty("latin_hypercube");
});

it("writes a hypercube with its ranges", () => {
  const draft = {
    ...newDraft("first-look"),
    vary: "hypercube" as const,
    points: 12,
    ranges: [{ path: "controller.adaptation_gain", min: "0.1", max: "10", log: true }],
  };
  expect(pointCount(draft)).toBe(12);
  expect(campaignOf(draft)).toMatchObject({
    latin_hypercube: {
      points: 12,
      seed: 1,
      ranges: { "controller.adaptation_gain": { min: 0.1, max: 10, scale: "log" } },
    },
  });
});

it("offers the paths of single values of the bench", () => {
  const document = { id: "x", title: "t", samples: 9, device: { id: "ch3", geometry: { fingers: 9 } }, events: [{}] };
  expect(pathsOf(document)).toEqual(["samples", "device.id", "device.geometry.fingers"]);
});

it("says what a path is", () => {
  expect(["sensor.noise_um", "environment.pressure_pa", "diagnosers.kalman.forgetting", "seed"].map(pathTitle)).toEqual(
    ["noise, µm · sensor", "pressure, Pa · environment", "forgetting · diagnosers kalman", "seed"],
  );
});
