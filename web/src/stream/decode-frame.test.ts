import { describe, expect, it } from "vitest";
import { encodeFrame } from "../testing/encode-frame";
import { decodeFrame } from "./decode-frame";

describe("decodeFrame", () => {
  it("reads headers, columns and newest values of every panel", () => {
    const frame = decodeFrame(
      encodeFrame({
        frame: 7,
        headTick: 1234,
        dtMs: 0.02,
        panels: [
          { panel: 3, revision: 2, startTick: 0, endTick: 4, flags: 0, min: [[1, 2]], max: [[3, 4]], latest: [9] },
          {
            panel: 4,
            revision: 1,
            startTick: 8,
            endTick: 9,
            flags: 5,
            min: [[-1], [-2]],
            max: [[1], [2]],
            latest: [5, 6],
          },
        ],
      }),
    );
    expect(frame).toMatchObject({ running: true, frame: 7, headTick: 1234, dtMs: 0.02 });
    const [first, second] = frame.panels;
    expect(first).toMatchObject({ panel: 3, revision: 2, signals: 1, columns: 2, startTick: 0, endTick: 4 });
    expect([...first.data]).toEqual([1, 2, 3, 4]);
    expect([...first.latest]).toEqual([9]);
    expect(second).toMatchObject({ panel: 4, triggered: true, waiting: false, frozen: true, columns: 1 });
    expect([...second.data]).toEqual([-1, 1, -2, 2]);
    expect([...second.latest]).toEqual([5, 6]);
  });

  it("keeps NaN as the mark of no data", () => {
    const frame = decodeFrame(
      encodeFrame({
        frame: 1,
        headTick: 0,
        dtMs: 0.01,
        panels: [
          {
            panel: 1,
            revision: 1,
            startTick: -1,
            endTick: 1,
            flags: 0,
            min: [[Number.NaN, 0]],
            max: [[Number.NaN, 0]],
            latest: [0],
          },
        ],
      }),
    );
    expect(frame.panels[0].data[0]).toBeNaN();
    expect(frame.panels[0].triggerTick).toBeNaN();
  });

  it("refuses another wire version and a torn message", () => {
    const good = encodeFrame({ frame: 1, headTick: 0, dtMs: 1, panels: [] });
    new Uint8Array(good)[0] = 3;
    expect(() => decodeFrame(good)).toThrow(/wire version 3/);
    expect(() => decodeFrame(new ArrayBuffer(8))).toThrow(RangeError);
  });
});
