import { expect, it } from "vitest";
import type { Account } from "../../api/types";
import { correctionLatex, densityLatex, floorLatex, posteriorLatex, texNumber } from "./why-latex";

const model = (name: string, residual: number, prior: number, posterior: number) => ({
  name,
  residual_um: [residual],
  covariance_um2: [[0.01]],
  log_likelihood: -0.5 * (residual ** 2 / 0.01 + Math.log(2 * Math.PI * 0.01)),
  prior,
  posterior,
  recorded: posterior,
  missed_sigma: Math.abs(residual) / 0.1,
  gain: [[0.1434], [0.554]],
});
const account: Account = {
  kind: "mmae",
  tick: 7,
  time_ms: 0.07,
  floor: 0.01,
  residuals: ["residual"],
  weighed: "the probabilities before",
  evidence: "",
  gain_units: ["1", "1/ms"],
  // exp(-r^2/2psi): 1 and exp(-2)
  models: [model("healthy", 0, 0.5, 0.8808), model("m+5", -0.2, 0.5, 0.1192)],
};

it.each([
  [0.12345, "0.1235"],
  [-3, "-3.000"],
  [2.5e-7, "250.0\\cdot10^{-9}"],
  [Number.NEGATIVE_INFINITY, "-\\infty"],
])("%s is set as %s", (value, tex) => expect(texNumber(value)).toBe(tex));

it("puts the numbers of the model into the density", () => {
  const tex = densityLatex(account.evidence, account.models[1]);
  expect(tex).toContain("\\frac{(-0.2000)^2}{0.01000}");
  expect(tex).toMatch(/=-0\.6164$/); // 1.38365 for a residual of 0, less 2
});

it("puts residuals along two axes into their joint density", () => {
  const both = { ...account.models[0], residual_um: [0.1, -0.2], log_likelihood: -0.25 };
  const tex = densityLatex("", {
    ...both,
    covariance_um2: [
      [0.04, 0.01],
      [0.01, 0.09],
    ],
  });
  expect(tex).toContain("r=\\begin{pmatrix}0.1000\\\\-0.2000\\end{pmatrix}");
  expect(tex).toContain("\\psi=\\begin{pmatrix}0.04000&0.01000\\\\0.01000&0.09000\\end{pmatrix}");
  expect(tex).toMatch(/=-0\.2500$/);
});

it("shows the evidence of a diagnoser that has another than the normal density, as it says it", () => {
  const tone = { ...account.models[1], log_likelihood: -0.25 };
  expect(densityLatex("-\\frac{T_k}{2W}", tone)).toBe("\\ln f=-\\frac{T_k}{2W}=-0.2500");
});

it("works out Bayes' rule: 0.5 against 0.5 exp(-2)", () => {
  expect(posteriorLatex(account, 0)).toMatch(/=0\.8808$/);
  expect(posteriorLatex(account, 1)).toMatch(/\\cdot0\.5000}{0\.5677}=0\.1192$/);
});

it("puts the gain and the residual into the correction of the state: K r", () => {
  expect(correctionLatex(account.models[1])).toBe(
    "Kr=\\begin{pmatrix}0.1434\\\\0.5540\\end{pmatrix}\\begin{pmatrix}-0.2000\\end{pmatrix}" +
      "=\\begin{pmatrix}-0.02868\\\\-0.1108\\end{pmatrix}",
  );
  expect(correctionLatex({ ...account.models[1], gain: [] })).toBeUndefined();
});

it("has nothing to work out before the first residual, and no floor where there is none", () => {
  const blank = { ...account, models: account.models.map((m) => ({ ...m, log_likelihood: null })) };
  expect(posteriorLatex(blank, 0)).toBeUndefined();
  expect(densityLatex("", blank.models[0])).toBeUndefined();
  expect(floorLatex({ ...account, floor: 0 }, 0)).toBeUndefined();
  expect(floorLatex(account, 1)).toMatch(/=0\.1192$/);
});
