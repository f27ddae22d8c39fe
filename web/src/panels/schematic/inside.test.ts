import { describe, expect, it } from "vitest";
import type { BlockCard, Signal } from "../../api/types";
import { type Inside, insideOf, type Place, quantityOf } from "./inside";

const port = (name: string, source = "") => ({ name, unit: "V", meaning: "", source, labels: [], each: "" });
const stage = (title: string, takes: string, gives: string) => ({
  title,
  takes: takes.split(" "),
  gives: gives.split(" "),
  equations: [],
});
const BANK = {
  inputs: [port("measured", "sensor.displacement"), port("sine", "@drive.sine"), port("partner", "sensor.y?")],
  structure: [
    stage("Filters", "measured", "residual state"),
    stage("Likelihoods", "residual weight", "likelihood"),
    stage("Weights", "likelihood", "weight probability"),
  ],
} as unknown as BlockCard;
const SIGNALS = [
  "sensor.displacement",
  "kalman.residual.healthy",
  "kalman.residual.m+5",
  ...Array.from({ length: 9 }, (_, i) => `kalman.probability.h${i}`),
  "loop.sine",
].map((name) => ({ name })) as Signal[];
const quantity = (name: string) => quantityOf(name, "kalman", BANK, { drive: "loop" }, SIGNALS);

describe("the quantity behind a name", () => {
  it("is what an input is wired to, also in another slot, or may be missing", () => {
    expect(quantity("measured").signals).toEqual([{ label: "", name: "sensor.displacement" }]);
    expect(quantity("sine").signals[0].name).toBe("loop.sine");
    expect(quantity("partner").signals).toEqual([]);
  });

  it("is the block's own signals, each by its label, as many as there is room for", () => {
    expect(quantity("residual").signals.map((s) => s.label)).toEqual(["healthy", "m+5"]);
    expect(quantity("probability").signals).toHaveLength(6);
    expect(quantity("probability").more).toBe(3);
    expect(quantity("state").signals).toEqual([]);
  });
});

const apart = (a: Place, b: Place) =>
  a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;

const onEdge = (places: Place[], x: number, y: number) =>
  places.some((p) => x >= p.x - 1 && x <= p.x + p.width + 1 && y >= p.y - 1 && y <= p.y + p.height + 1);

function ends(d: string): [number, number][] {
  const numbers = d.match(/-?[\d.]+/g)?.map(Number) ?? [];
  return [[numbers[0], numbers[1]] as [number, number], numbers.slice(-2) as [number, number]];
}

describe("the inside of a block", () => {
  const inside: Inside = insideOf(BANK, quantity);
  const places = [...inside.stages, ...inside.quantities];

  it("has each stage and each quantity once, apart, within the drawing", () => {
    expect(inside.stages.map((s) => s.title)).toEqual(["Filters", "Likelihoods", "Weights"]);
    expect(inside.quantities.map((q) => q.name).sort()).toEqual([
      "likelihood",
      "measured",
      "probability",
      "residual",
      "state",
      "weight",
    ]);
    for (const a of places) for (const b of places) expect(a === b || apart(a, b)).toBe(true);
    for (const p of places)
      expect(p.x >= 0 && p.x + p.width <= inside.width && p.y + p.height <= inside.height).toBe(true);
  });

  it("has a line for everything taken and given, from edge to edge, feedback too", () => {
    expect(inside.lines).toHaveLength(9);
    expect(inside.lines.filter((line) => line.enters)).toHaveLength(4);
    expect(inside.lines.some((line) => line.id === "of weight stage 1")).toBe(true);
    for (const { d, id } of inside.lines) for (const [x, y] of ends(d)) expect(onEdge(places, x, y), id).toBe(true);
  });

  it("goes from what is taken at the top to what is given at the bottom", () => {
    const y = (name: string) => inside.quantities.find((q) => q.name === name)?.y ?? 0;
    expect(y("measured")).toBeLessThan(y("residual"));
    expect(y("residual")).toBeLessThan(y("probability"));
  });
});

it("has no size where a block does not say what it is made of", () => {
  expect(insideOf({ ...BANK, structure: [] }, quantity)).toMatchObject({ width: 0, height: 0, stages: [], lines: [] });
});
