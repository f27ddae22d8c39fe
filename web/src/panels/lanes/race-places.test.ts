import { expect, it } from "vitest";
import { racePlaces } from "./race-places";

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

it("gives no places before anything has changed", () => expect(racePlaces({ kalman: [] })).toEqual({}));
