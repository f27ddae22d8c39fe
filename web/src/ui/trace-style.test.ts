import { expect, it } from "vitest";
import { hypothesisStyle, traceStyle } from "./trace-style";

const hypotheses = ["healthy", "m+5", "k+5"];
const signals = [
  "reference.voltage",
  "plant.displacement",
  "mrac.gain.r",
  "mrac.gain.w1",
  "kalman.probability.m+5",
  "kalman.residual.m+5",
];
const style = (name: string) => traceStyle(name, signals, hypotheses);

it("gives the same signal the same style wherever it is asked for", () => {
  expect(style("mrac.gain.r")).toEqual(style("mrac.gain.r"));
  expect(traceStyle("plant.displacement", [], [])).toEqual(style("plant.displacement"));
});

it("gives neighbouring signals different colours and dashes", () => {
  expect(style("mrac.gain.r").slot).not.toBe(style("mrac.gain.w1").slot);
  expect(style("mrac.gain.r").dash).not.toBe(style("mrac.gain.w1").dash);
});

it("gives everything of one hypothesis its colour", () => {
  expect(style("kalman.probability.m+5")).toEqual(hypothesisStyle(1));
  expect(style("kalman.residual.m+5").slot).toBe(hypothesisStyle(1).slot);
  expect(style("bank.residual_y.m+5").slot).toBe(hypothesisStyle(1).slot);
});

it("keeps the first eight hypotheses apart by colour alone", () => {
  expect(new Set(Array.from({ length: 8 }, (_, i) => hypothesisStyle(i).slot)).size).toBe(8);
});

it("gives the tenth hypothesis the colour of the second and a dash, as reports do", () => {
  expect(hypothesisStyle(9)).toEqual({ slot: hypothesisStyle(1).slot, dash: 1 });
});

it("gives the same signal of six twins six colours, none of them that of the board", () => {
  const twins = ["pid", "lqg", "mrac", "pole", "stvsc", "open"];
  const quantities = ["plant.displacement", "drive.voltage", "pid.integral", "plant.velocity"];
  const all = [...quantities, ...twins.flatMap((twin) => quantities.map((name) => `${twin}:${name}`))];
  for (const quantity of quantities) {
    const styles = ["", ...twins.map((twin) => `${twin}:`)].map((of) => traceStyle(of + quantity, all, hypotheses));
    expect(new Set(styles.map(({ slot }) => slot)).size).toBe(7);
    expect(new Set(styles.map(({ dash }) => dash)).size).toBe(1);
  }
});

it("gives a hypothesis of a twin the colour of the hypothesis", () => {
  expect(traceStyle("pid:kalman.probability.m+5", signals, hypotheses)).toEqual(hypothesisStyle(1));
});
