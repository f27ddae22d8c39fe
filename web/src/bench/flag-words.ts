import type { LogEntry } from "../api/types";
import { cardOf } from "../api/use-catalog";
import { formatShort } from "../ui/format";
import { hypothesisWords } from "./hypothesis-words";
import { severityScale, severityText } from "./severity";

const RATE = "rate.deg_per_s";

/** The few words on the flag of an event. */
export function flagWords({ kind, command, new: value }: LogEntry): string {
  if (kind === "recognised") return `found ${hypothesisWords(String(value))}`;
  if (kind === "truth_changed") return `truth: ${hypothesisWords(String(value))}`;
  if (kind in WORDS || !command) return WORDS[kind] ?? kind.replaceAll("_", " ");
  if ("fault" in command) return faultWords(command.fault, command.severity);
  if ("switch" in command) return titleOf("control", command.switch);
  if ("set" in command && typeof command.set[RATE] === "number")
    return `angular rate ${formatShort(command.set[RATE], "deg/s")}`;
  if ("set" in command) return `${Object.keys(command.set).map(leaf).join(", ")} changed`;
  return kind.replaceAll("_", " ");
}

const WORDS: Partial<Record<string, string>> = {
  heal: "healed",
  tripped: "stopped",
  reset_trip: "trip reset",
  make_safe: "safe outputs",
  scheduled: "waits",
  snapshot_taken: "kept",
};

function faultWords(name: string, severity: number): string {
  const card = cardOf("faults", name);
  if (!card) return titleOf("faults", name); // its unit is not known yet
  const parameter = card.parameters.find((p) => p.name === "severity");
  const scale = severityScale(parameter, card.suggested ?? 0);
  return `${titleOf("faults", name)} ${severityText(severity, scale, parameter?.unit ?? "")}`;
}

export const titleOf = (family: string, name: string) => cardOf(family, name)?.title ?? name.replaceAll("_", " ");

const leaf = (path: string) => path.slice(path.lastIndexOf(".") + 1).replaceAll("_", " ");

/** How loudly an event speaks: faults and trips are alarms, findings of diagnosers are news, run control is quiet. */
type EventTone = "alarm" | "found" | "change" | "quiet";

const TONES = {
  alarm: ["inject", "tripped", "make_safe", "failed", "refused"],
  found: ["recognised"],
  change: ["heal", "set", "switch", "truth_changed", "reset_trip", "scheduled", "reset", "restored", "snapshot_taken"],
};

/** By kind, for it is asked for each event in each frame. */
const TONE_OF = new Map(
  Object.entries(TONES).flatMap(([tone, kinds]) => kinds.map((kind) => [kind, tone as EventTone] as const)),
);

export const eventTone = ({ kind }: Pick<LogEntry, "kind">): EventTone => TONE_OF.get(kind) ?? "quiet";
