import { expect, it } from "vitest";
import type { Signal } from "../../api/types";
import { adaptiveUnits } from "./adaptation-strips";

const signals = (...names: string[]): Signal[] =>
  names.map((name, index) => ({ name, index, unit: "mixed", meaning: "", block: "", kind: "tap" }));

it("sets every gain beside its ideal value, then V, its derivative and the errors", () => {
  const [unit] = adaptiveUnits(
    signals(
      "mrac.error",
      "mrac.gain.r",
      "mrac.gain.y",
      "mrac.gain_ideal.r",
      "mrac.gain_ideal.y",
      "mrac.lyapunov",
      "mrac.lyapunov_rate",
      "mrac.augmented_error",
    ),
  );
  expect(unit.block).toBe("mrac");
  expect(unit.strips.map((s) => s.title)).toEqual([
    "gain r",
    "gain y",
    "V",
    "dV/dt by theory",
    "error",
    "augmented error",
  ]);
  expect(unit.strips[1].ideal).toBe("mrac.gain_ideal.y");
  expect(unit.strips.filter((s) => s.negative).map((s) => s.signal)).toEqual(["mrac.lyapunov_rate"]);
});

it("knows identifiers, sliding controllers and twins, and leaves out what does not adapt", () => {
  const found = adaptiveUnits(
    signals("ls.estimate.mass", "ls.truth.mass", "vsc.surface", "pid.error", "two:appb.gain", "faults.damping"),
    { vsc: 0.3 },
  );
  expect(found.map((u) => u.block)).toEqual(["ls", "vsc", "two:appb"]);
  expect(found[0].strips[0]).toMatchObject({ title: "estimate of mass", ideal: "ls.truth.mass" });
  expect(found[1].strips[0].layer).toBe(0.3);
  expect(found[2].strips[0].ideal).toBeUndefined();
});
