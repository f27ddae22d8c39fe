import { expect, it } from "vitest";
import { logEntry } from "../../testing/log-entry";
import { meanDelay, racePlaces, truthSwitches } from "./delays";

const entry = (tick: number, kind: string, text: string, old: unknown, fresh: unknown) =>
  logEntry({ seq: tick, tick, kind, text, old, new: fresh, actor: "board" });

it("pairs each change of the truth with the delay of its recognition, per diagnoser", () => {
  const log = [
    entry(100, "inject", "inject added_mass +0.05", null, null),
    entry(100, "truth_changed", "kalman: the truth is m+5", null, "m+5"),
    entry(100, "truth_changed", "imm: the truth is m+5", null, "m+5"),
    entry(156, "recognised", "kalman found m+5 after 37 samples (0.74 ms)", 37, "m+5"),
    entry(300, "truth_changed", "kalman: the truth is healthy", null, "healthy"),
  ];
  expect(truthSwitches(log, "kalman")).toEqual([
    { tick: 100, label: "m+5", delay: 37, findable: true, isStartUp: false },
    { tick: 300, label: "healthy", delay: undefined, findable: true, isStartUp: false },
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

it("takes the first truth for a start-up unless a fault acts already", () => {
  const healthy = entry(0, "truth_changed", "kalman: the truth is healthy", null, "healthy");
  const found = entry(45, "recognised", "kalman found healthy after 26 samples (260 µs)", 26, "healthy");
  const fault = entry(100, "inject", "inject added_mass +0.05", null, null);
  const heavier = entry(101, "truth_changed", "kalman: the truth is m+5", null, "m+5");
  const startUps = (log: (typeof heavier)[]) => truthSwitches(log, "kalman").map(({ isStartUp }) => isStartUp);
  expect(startUps([healthy, found])).toEqual([true]);
  expect(startUps([healthy, found, fault, heavier])).toEqual([true, false]);
  expect(startUps([fault, heavier])).toEqual([false]);
});

const change = (tick: number, delay: number | undefined) => {
  return { tick, label: "m+5", delay, findable: true, isStartUp: false };
};

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
  expect(meanDelay([7, 25, null, 0, 13])).toBe(19);
  expect(meanDelay([7, 0, null])).toBeUndefined();
});

it("gives no places before anything has changed", () => {
  expect(racePlaces({ kalman: [] })).toEqual({});
  expect(racePlaces({ kalman: [{ ...change(0, 26), isStartUp: true }] })).toEqual({});
});
