import { expect, it } from "vitest";
import type { Signal } from "../../api/types";
import { contestants } from "./contestants";

const signals = (...names: string[]): Signal[] =>
  names.map((name, index) => ({ name, index, unit: "1", meaning: "", block: "", kind: "output" }));

it("puts banks before states, and leaves out what says nothing", () => {
  const found = contestants({
    diagnosers: {
      regions: { kind: "regions", names: [], factors: [] },
      kalman: { kind: "mmae", names: ["healthy", "m+5"], factors: [] },
      mute: { kind: "moving_bank", names: [], factors: [] },
    },
    signals: signals(
      "regions.region",
      "kalman.probability.healthy",
      "kalman.probability.m+5",
      "kalman.winner",
      "kalman.truth",
      "mute.estimate",
    ),
  });
  expect(found.map((c) => c.id)).toEqual(["kalman", "regions"]);
  expect(found[0]).toMatchObject({ verdict: "kalman.winner", truth: true, names: ["healthy", "m+5"] });
  expect(found[1]).toMatchObject({ verdict: "regions.region", truth: false, probabilities: [] });
  expect(found[1].names[3]).toBe("danger");
  const blind = contestants({
    diagnosers: { kalman: { kind: "mmae", names: ["healthy"], factors: [] } },
    signals: signals("kalman.winner"),
  });
  expect(blind[0].truth).toBe(false); // while a fault is hidden
});
