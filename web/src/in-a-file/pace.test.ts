import { expect, it } from "vitest";
import { Pace } from "./pace";

/** Run pictures at these times; the ticks that each was asked for. */
function ticksAt(pace: Pace, times: readonly number[]): number[] {
  return times.map((now) => {
    let ran = 0;
    pace.run(now, (n) => {
      ran += n;
      return n;
    });
    return ran;
  });
}

it("runs as many ticks as device time has passed, and keeps the fractions", () => {
  expect(ticksAt(new Pace(0.01, 0.002), [0, 16, 32, 48, 64, 80])).toEqual([0, 3, 3, 3, 3, 4]);
});

it("makes up for no more than a tenth of a second: a page out of sight goes on where it was", () => {
  expect(ticksAt(new Pace(0.01, 0.002), [0, 60_000])).toEqual([0, 20]);
});

it("runs nothing while it is paused, and does not make up for the pause", () => {
  const pace = new Pace(0.01, 0.002);
  pace.isRunning = false;
  expect(ticksAt(pace, [0, 50])).toEqual([0, 0]);
  pace.isRunning = true;
  expect(ticksAt(pace, [60])).toEqual([2]);
});

it("stops asking when the board has stopped", () => {
  let asked = 0;
  new Pace(0.01, null).run(0, () => {
    asked += 1;
    return 0;
  });
  expect(asked).toBe(1);
});
