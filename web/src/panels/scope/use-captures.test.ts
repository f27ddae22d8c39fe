import { expect, it } from "vitest";
import { scopeConfig } from "../../stream/scope-config";
import type { CaptureList, CaptureMark } from "../../stream/wire";
import { captureWords } from "./capture-strip";
import { captureAt } from "./use-captures";
import { scopeSubscription } from "./use-time-view";

const mark = (tick: number): CaptureMark => ({
  tick,
  trigger_tick: tick - 0.5,
  start_tick: tick - 10,
  end_tick: tick + 30,
});
const marks = [100, 200, 300, 400].map(mark);
const list = (captures: CaptureMark[], isShort = false): CaptureList => ({
  type: "captures",
  panel: 1,
  captures,
  most: 50,
  is_short: isShort,
});

it("goes from live to the newest, then one by one, and stays at the ends", () => {
  expect(captureAt(marks, undefined, -1)?.tick).toBe(400);
  expect(captureAt(marks, marks[3], -1)?.tick).toBe(300);
  expect(captureAt(marks, marks[1], 1)?.tick).toBe(300);
  expect(captureAt(marks, marks[0], -1)?.tick).toBe(100);
  expect(captureAt(marks, marks[3], 1)?.tick).toBe(400);
  expect(captureAt(marks, marks[0], Number.POSITIVE_INFINITY)?.tick).toBe(400);
  expect(captureAt([], undefined, -1)).toBeUndefined();
});

it("from one that is kept no more it goes to its neighbours", () => {
  expect(captureAt(marks, mark(50), 1)?.tick).toBe(100);
  expect(captureAt(marks, mark(250), 1)?.tick).toBe(300);
  expect(captureAt(marks, mark(250), -1)?.tick).toBe(200);
  expect(captureAt(marks, mark(500), -1)?.tick).toBe(400);
});

it("says where it stands, how many are kept, and why they are few", () => {
  expect(captureWords(list(marks), marks[1], 0.01)).toBe("capture 2 of 4 at 1.995\u00a0ms");
  expect(captureWords(list(marks), mark(50), 0.01)).toBe("capture at 0.495\u00a0ms, no longer kept");
  expect(captureWords(list(marks), undefined, 0.01)).toBe("4\u00a0captures kept");
  expect(captureWords(list(marks, true), undefined, 0.01)).toBe("4\u00a0captures kept, all that memory has room for");
  expect(captureWords(list([]), undefined, 0.01)).toBe("no captures yet");
  expect(captureWords(list([], true), undefined, 0.01)).toBe("no room to keep captures of this window");
});

it("in the past a triggered scope still says whose captures it looks at, any other does not", () => {
  const config = scopeConfig(["a"], { windowMs: 4, mode: "triggered" });
  const past = { kind: "past", start: 90, end: 130, capture: marks[0] } as const;
  expect(scopeSubscription(config, past, 800, 0.01)).toMatchObject({
    mode: "frozen",
    start_tick: 90,
    end_tick: 130,
    width: 40,
    window_ms: 4,
    trigger: config.trigger,
  });
  expect(scopeSubscription({ ...config, mode: "roll" }, past, 800, 0.01)).not.toHaveProperty("trigger");
});
