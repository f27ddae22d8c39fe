import { expect, it } from "vitest";
import { logEntry } from "../../stream/log-entry.fixture";
import { foundDelays, meanDelay, racePlaces, truthSwitches } from "./delays";

const entry = (tick: number, kind: string, text: string, old: unknown, fresh: unknown) =>
  logEntry({ seq: tick, tick, kind, text, old, new: fresh, actor: "board" });

it("pairs each change of the truth with the delay of its recognition, per diagnoser", () => {
  const log = [
    entry(100, "truth_changed", "kalman: the truth is m+5", null, "m+5"),
    entry(100, "truth_changed", "imm: the truth is m+5", null, "m+5"),
    entry(156, "recognised", "kalman found m+5 after 37 samples (0.74 ms)", 37, "m+5"),
    entry(300, "truth_changed", "kalman: the truth is healthy", null, "healthy"),
  ];
  expect(truthSwitches(log, "kalman")).toEqual([
    { tick: 100, label: "m+5", delay: 37, findable: true },
    { tick: 300, label: "healthy", delay: undefined, findable: true },
  ]);
  expect(truthSwitches(log, "imm")[0].delay).toBeUndefined();
});

it("does not wait for a truth that is none of the hypotheses", () => {
  const log = [
    entry(10, "truth_changed", "kalman: the truth is none of the hypotheses", null, "none of the hypotheses"),
  ];
  expect(truthSwitches(log, "kalman")[0].findable).toBe(false);
});

it("measures a twin's diagnoser by the truth of the board, whose faults it shares", () => {
  const log = [
    entry(100, "truth_changed", "kalman: the truth is m+5", null, "m+5"),
    entry(300, "truth_changed", "kalman: the truth is healthy", null, "healthy"),
    entry(156, "recognised", "mrac: kalman found m+5 after 19 samples (0.38 ms)", 19, "m+5"),
  ];
  const delays = (id: string) => truthSwitches(log, id).map((change) => [change.tick, change.delay]);
  const late = [
    [100, 19],
    [300, undefined],
  ];
  expect(delays("mrac:kalman")).toEqual(late);
  expect(delays("kalman").map(([, delay]) => delay)).toEqual([undefined, undefined]);
  // a bank that only the twin has
  expect(delays("mrac:imm").map(([tick]) => tick)).toEqual([100, 300]);
});

const change = (tick: number, delay: number | undefined) => ({ tick, label: "m+5", delay, findable: true });

it("ranks by the delay of the latest change; who has not found it has no place", () => {
  expect(
    racePlaces({
      kalman: [change(100, 90), change(500, 30)],
      imm: [change(100, 10), change(500, 12)],
      lock_in: [change(100, 5), change(500, undefined)],
      slow: [change(100, 5)],
      other: [change(500, 30)],
    }),
  ).toEqual({ imm: 1, kalman: 2, other: 2 });
});

it("gives no place to a diagnoser that said so before: one that never leaves healthy is not the first", () => {
  const healthy = (delay: number) => ({ ...change(700, delay), label: "healthy" });
  expect(racePlaces({ printed: [healthy(0)], mended: [healthy(13)], slow: [healthy(20)] })).toEqual({
    mended: 1,
    slow: 2,
  });
  expect(foundDelays([25, null, 0, 13])).toEqual([25, 13]);
  expect(meanDelay(foundDelays([0, null]))).toBeUndefined();
});

it("gives no places before anything has changed", () => expect(racePlaces({ kalman: [] })).toEqual({}));
