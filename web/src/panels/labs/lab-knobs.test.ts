import { expect, it } from "vitest";
import type { BlockCard, Parameter } from "../../api/types";
import { labsOf, memorySamples } from "./lab-knobs";

const parameter = (name: string, live = true): Parameter =>
  ({ name, live, unit: "1", default: 1, minimum: 0, maximum: null }) as unknown as Parameter;
const card = (names: string[], live = true): BlockCard =>
  ({ parameters: names.map((name) => parameter(name, live)) }) as unknown as BlockCard;

const parameters = {
  sensor: { kind: "ideal" },
  sensors: { ideal: { noise_um: 0.05 } },
  diagnosers: { kalman: { kind: "mmae", assumed_noise_scale: 4 }, adaptive: { kind: "self_tuning", forgetting: 0.9 } },
};
const cards: Record<string, BlockCard> = {
  "sense ideal": card(["noise_um"]),
  "diagnose mmae": card(["assumed_noise_scale", "probability_floor"]),
  "diagnose self_tuning": card(["forgetting"]),
  "reference sine": card(["amplitude_v"], false),
};
const block = (family: string, name: string) => cards[`${family} ${name}`];

it("sets what is true beside what a bank assumes", () => {
  const labs = labsOf({ parameters }, "kalman", block);
  expect(labs.map((l) => l.name)).toEqual(["True values", "Assumed values"]);
  expect(labs[0].knobs).toMatchObject([{ path: "sensor.noise_um", value: 0.05 }]);
  expect(labs[1].knobs[0]).toMatchObject({ path: "diagnosers.kalman.assumed_noise_scale", value: 4 });
});

it("gives one that forgets its factor, and leaves out what cannot change live", () => {
  const labs = labsOf({ parameters }, "adaptive", block);
  expect(labs.at(-1)).toMatchObject({ name: "Memory", knobs: [{ value: 0.9 }] });
  expect(labs.flatMap((l) => l.knobs).some((k) => k.path === "reference.amplitude_v")).toBe(false);
});

it("remembers ten samples at 0.9", () => expect(memorySamples(0.9)).toBeCloseTo(10));
