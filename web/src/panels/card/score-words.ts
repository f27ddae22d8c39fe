import { formatNumber, formatPercent } from "../../ui/format";

const COUNTS = ["false_switches", "delay"];

/**
 * A figure of a diagnoser's score in words: hypotheses by name, counts whole, shares in percent; undefined for what is a number like
 * any other.
 */
export function scoreWords(signal: string, value: number, names: readonly string[]): string | undefined {
  const port = signal.slice(signal.lastIndexOf(".") + 1);
  if (port === "winner" || port === "truth") return names[value] ?? "none of these";
  if (port === "delay" && value < 0) return "not found";
  if (COUNTS.includes(port)) return formatNumber(value, 0);
  if (port === "correct_fraction") return formatPercent(value, 2);
  return undefined;
}
