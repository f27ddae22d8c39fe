import { afterEach, expect, it } from "vitest";
import type { Bench, Score } from "../api/types";
import { logEntry } from "./log-entry.fixture";
import { veil } from "./veil";

const event = (seq: number, kind: string) =>
  logEntry({ seq, tick: seq, kind, text: kind, old: null, new: null, actor: "board" });

const SCORES = { kalman: {} as Score };
const BENCH = {
  tick: 1,
  faults: [{ name: "added_mass" }],
  pending: [{}],
  diagnosers: { kalman: {}, detector: {} },
  signals: [
    ...["plant.displacement", "ideal.displacement", "mrac.gain.r", "b:mrac.gain.r"],
    ...["effects.mass_scale", "faults.added_mass", "b:effects.mass_scale", "mrac.gain_ideal.r"],
    ...["mrac.parameter_true.a1", "rls.truth.a1", "rls.error_pct"],
    ...["kalman.winner", "kalman.residual.m+5", "b:kalman.winner", "detector.alarm"],
  ].map((name) => ({ name })),
} as unknown as Bench;

afterEach(() => {
  veil.lift();
});

it("lets everything through until it drops", () => {
  expect(veil.bench(BENCH)).toBe(BENCH);
  expect(veil.scores(SCORES)).toBe(SCORES);
  expect(veil.events([event(1, "inject")])).toHaveLength(1);
});

it("holds back what tells, and gives it back when lifted", () => {
  veil.show("a");
  veil.drop("a");
  const { faults, pending, signals } = veil.bench(BENCH);
  expect([faults, pending]).toEqual([[], []]);
  expect(signals.map((s) => s.name)).toEqual([
    "plant.displacement",
    "ideal.displacement",
    "mrac.gain.r",
    "b:mrac.gain.r",
  ]);
  expect(veil.bench({ ...BENCH, tick: 9 }).signals).toBe(signals); // else every status would begin all feeds anew
  expect(veil.scores(SCORES)).toEqual({});
  const shown = veil.events([event(1, "inject"), event(2, "switch"), event(3, "recognised"), event(4, "verdict")]);
  expect(shown.map((e) => e.kind)).toEqual(["switch"]);
  expect(veil.lift().map((e) => e.seq)).toEqual([1, 3, 4]);
  expect(veil.on).toBe(false);
});

it("lies over its own bench only, and is there again when that is shown again", () => {
  veil.show("a");
  veil.drop("a");
  veil.events([event(1, "inject")]);
  veil.show("b");
  expect(veil.on).toBe(false);
  expect(veil.events([event(1, "inject")])).toHaveLength(1);
  veil.show("a");
  expect(veil.events([event(1, "inject"), event(2, "switch")]).map((e) => e.seq)).toEqual([2]);
  expect(veil.lift().map((e) => e.seq)).toEqual([1]);
});
