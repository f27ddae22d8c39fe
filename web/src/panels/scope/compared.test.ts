import { expect, it } from "vitest";
import { comparedOf } from "./compared";
import type { PlotTrace } from "./paint-scope";

const trace = (name: string, rest: Partial<PlotTrace> = {}): PlotTrace => ({
  name,
  unit: "deg/s",
  slot: 0,
  colour: "",
  dash: 0,
  ...rest,
});
const spaced = (text: string) => text.replaceAll(/\s/g, " ");

it("compares the controller that drives with the one that drove before", () => {
  const traces = [
    trace("rate.rate"),
    trace("rebalance.rate", { drives: [{ name: "rebalance", from: 500, until: Number.POSITIVE_INFINITY }] }),
    trace("open.rate", { drives: [{ name: "open", from: 0, until: 500 }] }),
  ];
  const figures = { before: [100, 0.1, 76], after: [100, 99, 0.3], settled: [true, true, true] };
  const said = comparedOf(traces, figures, 500).map(({ trace: { name }, before, after }) => [name, before, after]);
  expect(said.map((one) => one.map(spaced))).toEqual([
    ["rebalance.rate", "76.0 deg/s", "99.0 deg/s"],
    ["rate.rate", "100 deg/s", "100 deg/s"],
  ]);
});
