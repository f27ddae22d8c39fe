import type { Claim } from "../../api/types";
import { formatFigure } from "../../ui/format";
import { metricScale } from "../../ui/metric-name";

/** A range in words: "1.71 to 1.89 µm", "at least 1.67 µm". */
export function rangeText(low: number | null, high: number | null, say: (value: number) => string): string {
  if (low !== null && high !== null) return low === high ? say(low) : `${say(low)} to ${say(high)}`;
  if (low !== null) return `at least ${say(low)}`;
  return high === null ? "any" : `at most ${say(high)}`;
}

/** The numbers of a claim in words, all in one unit. */
export function claimWords(claim: Claim) {
  const { metric, low, high, printed_low, printed_high, published_value, measured } = claim;
  const { name, unit, shown } = metricScale(metric, [low, high, printed_low, printed_high, published_value, measured]);
  const bare = (value: number) => formatFigure(metric, shown(value));
  const say = (text: string) => (unit && text !== "any" ? `${text}\u00a0${unit}` : text);
  const range = rangeText(printed_low, printed_high, bare);
  const printed = published_value === null ? range : `${bare(published_value)} (${range} agrees)`;
  return {
    name,
    printed: claim.is_published ? say(printed) : "nothing",
    expected: say(rangeText(low, high, bare)),
    measured: measured === null ? "not yet" : say(bare(measured)),
  };
}

/** The state of a claim in a few words. */
export function stateWords({ state, is_published }: Pick<Claim, "state" | "is_published">): string {
  if (state === "not yet") return "not yet";
  if (is_published) return state === "holds" ? "holds as printed" : "does not hold as printed";
  return state === "holds" ? "as expected" : "other than expected";
}
