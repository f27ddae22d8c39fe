// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import type { Claim, ClaimKnob, ClaimList } from "../../api/types";
import { partnersOf, signalsOf } from "./claim-signals";
import { claimWords, rangeText, stateWords } from "./claim-words";
import { slideSvg } from "./slide";
import { commandFor, nearest } from "./threshold-view";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const CLAIM: Claim = {
  metric: "control.effort_ratio",
  published: "almost 80 % stronger",
  published_value: 1.8,
  printed_low: 1.71,
  printed_high: 1.89,
  is_published: true,
  expected: "1.772 ± 0.035",
  low: 1.737,
  high: 1.807,
  note: "",
  reason: "",
  fitted: [],
  measured: 1.7723,
  as_expected: true,
  state: "holds",
  verdict: "reproduced",
  marks: [
    {
      figure: "3.1.3.2.2",
      section: "3.1.3.2",
      words: "almost 80% stronger signals <than> the input",
      number: "80%",
      reading: "",
      kind: "value",
      signal: "drive.voltage",
      unit: "V",
      low: null,
      high: null,
      values: [18],
      from_tick: 0,
      until_tick: null,
      problem: "",
    },
  ],
  knobs: [],
};
const LIST = {
  title: "Case 1",
  source: "3.1.3.2",
  claim: "",
  version: "9.8.7",
  scenario_id: "ch3-case1",
  seed: 42,
  tick: 10_000,
} as ClaimList;

it("writes the numbers of a claim in one unit", () => {
  expect(claimWords(CLAIM)).toEqual({
    name: "effort ratio",
    printed: "1.800 (1.710 to 1.890 agrees)",
    expected: "1.737 to 1.807",
    measured: "1.772",
  });
  const error = {
    ...CLAIM,
    metric: "control.tail_rms_error_um",
    low: null,
    high: 0.01,
    measured: 0.0021,
    published_value: null,
  };
  const bare = { ...error, is_published: false, printed_low: null, printed_high: null };
  expect(claimWords(bare)).toMatchObject({
    printed: "nothing",
    expected: "at most 0.01000\u00a0µm",
    measured: "0.002100\u00a0µm",
  });
  expect(claimWords({ ...bare, measured: null }).measured).toBe("not yet");
});

it("says ranges by the ends they have", () => {
  const say = (value: number) => String(value);
  expect(rangeText(1, 2, say)).toBe("1 to 2");
  expect(rangeText(2, 2, say)).toBe("2");
  expect(rangeText(1, null, say)).toBe("at least 1");
  expect(rangeText(null, 2, say)).toBe("at most 2");
});

it("says what a claim comes to", () => {
  expect(stateWords({ state: "not yet", is_published: true })).toBe("not yet");
  expect(stateWords({ state: "holds", is_published: true })).toBe("holds as printed");
  expect(stateWords({ state: "fails", is_published: false })).toBe("other than expected");
});

it("makes a slide of 16 to 9 with the words, both numbers, verdict, seed and version", () => {
  const document = new DOMParser().parseFromString(slideSvg(CLAIM, LIST, undefined), "image/svg+xml");
  expect(document.querySelector("parsererror")).toBeNull();
  const root = document.documentElement;
  expect(Number(root.getAttribute("width")) / Number(root.getAttribute("height"))).toBeCloseTo(16 / 9);
  const said = [...document.querySelectorAll("text")].map((node) => node.textContent ?? "");
  const all = said.join("\n");
  expect(all).toContain("Figure 3.1.3.2.2, section 3.1.3.2");
  expect(all).toContain("“almost 80% stronger signals <than> the input”");
  expect(said).toContain("1.772");
  expect(all).toContain("1.800");
  expect(said).toContain("reproduced");
  expect(said).toContain("holds as printed");
  expect(all).toContain("CombBench 9.8.7 · ch3-case1 · seed 42");
  // the letters can be read from the last row, but for the foot
  const sizes = [...document.querySelectorAll("text")].map((node) => Number(node.getAttribute("font-size")));
  expect(sizes.sort((a, b) => a - b).slice(0, 2)).toEqual([15, 18]);
});

it("knows what belongs beside a signal, and what a metric is about", () => {
  expect(partnersOf(["drive.voltage"])).toEqual(["reference.voltage"]);
  expect(partnersOf(["drive.voltage", "reference.voltage"])).toEqual([]);
  const known = ["plant.displacement", "model.displacement", "drive.voltage", "kalman.probability.a", "kalman.nis.a"];
  expect(signalsOf("diagnosis.kalman.correct_fraction", known)).toEqual(["kalman.probability.a"]);
  expect(signalsOf("twins.b30.control.effort_ratio", known)).toEqual(["drive.voltage"]);
  const weighted = ["kalman.weighted.displacement", "kalman.weighted.mass"];
  const more = [...weighted, ...known];
  expect(signalsOf("estimation.kalman.rms_error_um", more)).toEqual([weighted[0], "plant.displacement"]);
  expect(signalsOf("estimation.kalman.rms_error_mass_pct", more)).toEqual([weighted[1]]);
  const axes = ["bank.weighted.rate", "rate.rate", "bank.weighted.x", "plant.x", ...known];
  expect(signalsOf("estimation.bank.rms_error_rate_dps", axes)).toEqual(axes.slice(0, 2));
  expect(signalsOf("estimation.bank.rms_error_x_um", axes)).toEqual(axes.slice(2, 4));
  expect(signalsOf("control.amplitude_um", known)).toEqual(["plant.displacement", "model.displacement"]);
});

it("turns a severity by a fault, anything else by a value", () => {
  const knob = { path: "sensor.noise_um", fault: null } as ClaimKnob;
  expect(commandFor(knob, 0.1)).toEqual({ set: { "sensor.noise_um": 0.1 } });
  expect(commandFor({ ...knob, path: "events.0.severity", fault: "ageing" }, 2)).toEqual({
    fault: "ageing",
    severity: 2,
  });
  expect(nearest([{ value: 1 }, { value: 3 }], 2.1)).toEqual({ value: 3 });
  expect(nearest([], 2)).toBeUndefined();
});
