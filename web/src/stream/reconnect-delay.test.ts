import { expect, it } from "vitest";
import { reconnectDelay } from "./reconnect-delay";

it("waits 0.5, 1, 2, 5, 5 s in the middle of the jitter", () => {
  expect([0, 1, 2, 3, 9].map((n) => reconnectDelay(n, () => 0.5))).toEqual([500, 1000, 2000, 5000, 5000]);
});

it("jitters by at most 20 % so that many pages do not return at once", () => {
  expect(reconnectDelay(0, () => 0)).toBeCloseTo(400);
  expect(reconnectDelay(3, () => 1)).toBeCloseTo(6000);
});
