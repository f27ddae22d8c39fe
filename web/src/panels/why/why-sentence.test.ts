import { describe, expect, it } from "vitest";
import type { Account } from "../../api/types";
import { turnWords, whySentence } from "./why-sentence";

/** An account by the shares and the misses of its models, in the order of their names. */
function account(shares: number[], sigmas: number[], rest: Partial<Account> = {}): Account {
  return {
    kind: "mmae",
    tick: 120,
    time_ms: 1.2,
    floor: 0.001,
    residuals: ["residual"],
    weighed: "",
    evidence: "",
    gain_units: [],
    models: ["healthy", "m+5", "m+10"].map((name, i) => ({
      name,
      residual_um: [sigmas[i] * 0.1],
      covariance_um2: [[0.01]],
      log_likelihood: -0.5 * sigmas[i] ** 2,
      prior: 1 / 3,
      posterior: shares[i],
      recorded: shares[i],
      missed_sigma: sigmas[i],
      gain: [],
    })),
    ...rest,
  };
}

const sentence = (shares: number[], sigmas: number[], rest?: Partial<Account>, before?: string) =>
  whySentence(account(shares, sigmas, rest), before ? { tick: 120, before, since: 0 } : undefined, 120);

describe("the verdict in one sentence", () => {
  it("sets the winner beside healthy", () =>
    expect(sentence([0.1, 0.8, 0.1], [3.52, 0.88, 2])).toBe(
      "Mass +5\u00a0% wins: it misses by 0.9 σ, healthy by 3.5 σ.",
    ));
  it("sets healthy beside its nearest rival", () =>
    expect(sentence([0.8, 0.05, 0.15], [0.5, 3, 2.04])).toBe(
      "healthy wins: it misses by 0.5 σ, mass +10\u00a0% by 2.0 σ.",
    ));
  it("sets the winner beside what it has just beaten", () =>
    expect(sentence([0.1, 0.3, 0.6], [5, 3, 1], {}, "m+5")).toBe(
      "Mass +10\u00a0% wins: it misses by 1.0 σ, mass +5\u00a0% by 3.0 σ.",
    ));
  it("says when the samples before decide", () => {
    expect(sentence([0.1, 0.8, 0.1], [0.4, 1.9, 2])).toBe(
      "Mass +5\u00a0% wins by the samples before: here it misses by 1.9 σ, healthy only by 0.4 σ.",
    );
    expect(sentence([0.1, 0.8, 0.1], [1.04, 1.01, 2])).toBe(
      "Mass +5\u00a0% wins by the samples before: here it and healthy both miss by 1.0 σ.",
    );
  });
  it("names what is measured where it is not one displacement", () => {
    expect(sentence([0.1, 0.8, 0.1], [4, 1, 2], { residuals: ["residual_x", "residual_y"] })).toContain(
      "misses on both axes together by 1.0 σ, healthy by 4.0 σ",
    );
    expect(sentence([0.1, 0.8, 0.1], [4, 1, 2], { evidence: "-T" })).toContain("misses the tone of the drive by 1.0 σ");
  });
  it("does not call a sample evidence that was none", () => {
    const { models } = account([0.9, 0.05, 0.05], [1, 2, 3]);
    expect(
      whySentence(account([], [], { models: models.map((m) => ({ ...m, posterior: 1 / 3 })) }), undefined, 120),
    ).toBe("healthy stays ahead: this sample did not count, because the drive was too small or nothing was measured.");
    const untold = models.map((m) => ({ ...m, log_likelihood: null }));
    expect(whySentence(account([], [], { models: untold }), undefined, 120)).toBe(
      "healthy stays ahead: this sample tells nothing.",
    );
    expect(sentence([1 / 3, 1 / 3, 1 / 3], [0, 0, 0])).toBe("The hypotheses are all alike so far.");
  });
});

it.each([
  [{ tick: null, before: "", since: 40 }, "The verdict has not turned since sample 40, the first one kept."],
  [{ tick: 100, before: "healthy", since: 0 }, "The verdict last turned at sample 100, from healthy."],
  [{ tick: 120, before: "healthy", since: 0 }, "The verdict turned at this sample, from healthy."],
])("says where the verdict turned: %o", (turn, words) => expect(turnWords(turn, 120)).toBe(words));
