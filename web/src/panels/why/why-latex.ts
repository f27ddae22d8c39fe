import type { Account, ModelAccount } from "../../api/types";
import { formatSi, inTex } from "../../ui/format";

/** A number for an equation: four digits, a power of ten where it needs one. */
export function texNumber(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return value < 0 ? "-\\infty" : "\\infty";
  return inTex(formatSi(value, "", digits));
}

const bracketed = (value: number) => (value < 0 ? `(${texNumber(value)})` : texNumber(value));

/** The density of a model's residual: the normal one with its numbers put in, or what its diagnoser has instead. */
export function densityLatex(evidence: string, model: ModelAccount): string | undefined {
  const { residual_um: residuals, covariance_um2: covariance, log_likelihood: log } = model;
  if (log === null || covariance === null) return undefined;
  if (evidence) return `\\ln f=${evidence}=${texNumber(log)}`;
  if (residuals.length > 1) return jointLatex(residuals, covariance, log);
  const [r] = residuals;
  const [[psi]] = covariance;
  return (
    "\\ln f=-\\tfrac12\\Bigl(\\frac{r^2}{\\psi}+\\ln 2\\pi\\psi\\Bigr)" +
    `=-\\tfrac12\\Bigl(\\frac{${bracketed(r)}^2}{${texNumber(psi)}}+\\ln(2\\pi\\cdot${texNumber(psi)})\\Bigr)` +
    `=${texNumber(log)}`
  );
}

/** The density of several residuals at once, with their numbers put in. */
function jointLatex(residuals: number[], covariance: number[][], log: number): string {
  const r = matrixLatex(residuals.map((value) => [value]));
  return (
    `r=${r},\\quad\\psi=${matrixLatex(covariance)},\\quad` +
    "\\ln f=-\\tfrac12\\bigl(r^T\\psi^{-1}r+\\ln\\det2\\pi\\psi\\bigr)" +
    `=${texNumber(log)}`
  );
}

/** The correction by the Kalman gain, with its numbers; undefined without a filter. */
export function correctionLatex({ gain, residual_um: residuals }: ModelAccount): string | undefined {
  if (gain.length === 0) return undefined;
  const moved = gain.map((row) => [row.reduce((sum, k, j) => sum + k * residuals[j], 0)]);
  return `Kr=${matrixLatex(gain)}${matrixLatex(residuals.map((r) => [r]))}=${matrixLatex(moved)}`;
}

const matrixLatex = (rows: number[][]) =>
  `\\begin{pmatrix}${rows.map((row) => row.map((value) => texNumber(value)).join("&")).join("\\\\")}\\end{pmatrix}`;

/**
 * Bayes' rule for one model with its numbers put in.
 *
 * Densities are divided by the density of the likeliest model, which changes no probability and keeps the numbers readable.
 */
export function posteriorLatex(account: Account, index: number): string | undefined {
  const logs = account.models.map((m) => m.log_likelihood);
  if (logs.some((log) => log === null)) return undefined;
  const best = Math.max(...logs.map(Number));
  const weights = account.models.map((m, i) => Math.exp(Number(logs[i]) - best) * m.prior);
  const total = weights.reduce((sum, w) => sum + w, 0);
  const own = account.models[index];
  return (
    "p=\\frac{f\\,p^-}{\\sum_j f_j\\,p^-_j}" +
    `=\\frac{e^{${texNumber(Number(logs[index]))}-${bracketed(best)}}\\cdot${texNumber(own.prior)}}{${texNumber(total)}}` +
    `=${texNumber(weights[index] / total)}`
  );
}

/** The effect of the floor, if there is a floor. */
export function floorLatex(account: Account, index: number): string | undefined {
  const { floor, models } = account;
  if (floor === 0) return undefined;
  return (
    `p\\leftarrow\\frac{\\max(p,\\,${texNumber(floor, 2)})}{\\sum_j\\max(p_j,\\,${texNumber(floor, 2)})}` +
    `=${texNumber(models[index].posterior)}`
  );
}
