import type { Document } from "../../api/types";
import { section } from "../card/instances";
import type { DrawnBox } from "./loop";

/** A stage of the board at a box: a mark with room for few letters, and words. */
export type StageMark = NonNullable<DrawnBox["stage"]>;

/** The stages of the board that act: behind the converter of the drive, and before the converter of the sensor. */
export function stageMarks(document: Document): { drive?: StageMark; sensor?: StageMark } {
  const board = section(document, "board") as Record<string, number | undefined>;
  const { delay_samples = 0, delay_fraction = 0, amplifier_khz = 0, slew_v_per_us = 0 } = board;
  const { antialias_khz = 0, jitter_us = 0 } = board;
  const late = delay_samples + delay_fraction;
  return {
    drive: mark([
      [late, "late", `arrives ${late} ${late === 1 ? "sample" : "samples"} late`],
      [amplifier_khz, "slow", `through an amplifier of ${amplifier_khz} kHz`],
      [slew_v_per_us, "slow", `with a slew of ${slew_v_per_us} V/µs`],
    ]),
    sensor: mark([
      [antialias_khz, "filter", `behind a filter of ${antialias_khz} kHz`],
      [jitter_us, "jitter", `sampled with a jitter of ${jitter_us} µs`],
    ]),
  };
}

function mark(stages: [value: number, mark: string, words: string][]): StageMark | undefined {
  const acting = stages.filter(([value]) => value > 0);
  if (acting.length === 0) return undefined;
  return { mark: acting[0][1], words: acting.map(([, , words]) => words).join(", ") };
}
