import { expect, it } from "vitest";
import { stageMarks } from "./stages";

it("marks nothing on a bench whose stages are off", () => {
  expect(stageMarks({})).toEqual({ drive: undefined, sensor: undefined });
  expect(stageMarks({ board: { delay_samples: 0, jitter_us: 0 } })).toEqual({ drive: undefined, sensor: undefined });
});

it("marks the first stage that acts, and names them all", () => {
  const board = { delay_samples: 1, delay_fraction: 0.5, slew_v_per_us: 0.2, jitter_us: 0.1 };
  expect(stageMarks({ board })).toEqual({
    drive: { mark: "late", words: "arrives 1.5 samples late, with a slew of 0.2 V/µs" },
    sensor: { mark: "jitter", words: "sampled with a jitter of 0.1 µs" },
  });
  expect(stageMarks({ board: { amplifier_khz: 40, antialias_khz: 20 } })).toEqual({
    drive: { mark: "slow", words: "through an amplifier of 40 kHz" },
    sensor: { mark: "filter", words: "behind a filter of 20 kHz" },
  });
});
