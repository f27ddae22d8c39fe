import { formatNumber } from "../../ui/format";

const COUNTS = ["false_switches", "delay"];

/**
 * A figure of a diagnoser's score in words: hypotheses by name, counts whole; undefined for what is a number like
 * any other.
 */
export function scoreWords(signal: string, value: number, names: readonly string[]): string | undefined {
  const port = signal.slice(signal.lastIndexOf(".") + 1);
  if (port === "winner" || port === "truth") return names[value] ?? "none of these";
  if (port === "delay" && value < 0) return "not found";
  if (COUNTS.includes(port)) return formatNumber(value, 0);
  return undefined;
}
