import { expect, it } from "vitest";
import type { PanelFrame } from "../../stream/panel-frame";
import { whileDriving } from "./while-driving";

it("keeps the columns in which the controller drove", () => {
  const frame = { startTick: 100, endTick: 140, columns: 4 } as PanelFrame;
  const values = new Float32Array([1, 2, 3, 4]);
  const spans = [
    { name: "open", from: 0, until: 110 },
    { name: "open", from: 130, until: Number.POSITIVE_INFINITY },
  ];
  const { low, high } = whileDriving({ low: values, high: values }, frame, spans);
  expect([...low]).toEqual([1, Number.NaN, Number.NaN, 4]);
  expect([...high]).toEqual([...low]);
  expect([...values]).toEqual([1, 2, 3, 4]);
});
