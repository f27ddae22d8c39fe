import type { BlockCard, Command, FaultProfile, Parameter } from "../../api/types";
import { type SeverityScale, severityText } from "../../bench/severity";
import { groupBy } from "../../ui/group-by";
import { roundTo } from "../../ui/unit-scale";
import { type Condition, conditionText } from "../condition/condition";

/** A number, or the text of a field without a number. */
export type Entry = number | string;

export interface FaultDraft {
  severity: Entry;
  profile: FaultProfile["kind"];
  durationMs: Entry;
  periodMs: Entry;
  duty: Entry;
  moment: "now" | "at" | "when";
  atMs: Entry;
  when: Condition;
  /** Chosen parameters of the fault. */
  parameters: Record<string, unknown>;
}

const SHARED = ["severity", "profile", "start_tick"];

/** The parameters that only this fault has. */
export const ownParameters = (fault: Pick<BlockCard, "parameters">): Parameter[] =>
  fault.parameters.filter((p) => !SHARED.includes(p.name));

export function newDraft(severity: number): FaultDraft {
  return {
    severity,
    profile: "step",
    durationMs: 5,
    periodMs: 2,
    duty: 0.5,
    moment: "now",
    atMs: 0,
    when: { signal: "", above: true, level: 2 },
    parameters: {},
  };
}

/** Reasons against sending the form, by field; only fields that the choices use count. */
export function refusals(draft: FaultDraft, scale: SeverityScale, unit: string) {
  const { severity, profile, durationMs, periodMs, duty, moment, atMs, when } = draft;
  const found: Partial<Record<keyof FaultDraft, string>> = {};
  if (!isNumber(severity)) found.severity = "Say how much";
  else if (severity < scale.minimum) found.severity = `At least ${severityText(scale.minimum, scale, unit)}`;
  else if (severity > scale.maximum) found.severity = `At most ${severityText(scale.maximum, scale, unit)}`;
  if (profile === "ramp" && !(isNumber(durationMs) && durationMs > 0)) found.durationMs = "Say over how many ms";
  if (profile === "intermittent") {
    if (!(isNumber(periodMs) && periodMs > 0)) found.periodMs = "Say every how many ms";
    if (!(isNumber(duty) && duty > 0 && duty <= 1)) found.duty = "Say for how much of it";
  }
  if (moment === "at" && !(isNumber(atMs) && atMs >= 0)) found.atMs = "Say at how many ms";
  if (moment === "when" && !isNumber(when.level)) found.when = "Say at what value";
  return found;
}

const isNumber = (entry: Entry): entry is number => typeof entry === "number" && Number.isFinite(entry);

/** An entry in another unit; a text stays as it was typed. */
export const scaled = (entry: Entry, factor: number): Entry =>
  typeof entry === "number" ? roundTo(entry * factor, 10) : entry;

/** The command of the form; ask for refusals first. */
export function injectCommand(fault: string, draft: FaultDraft): Command {
  const profile: FaultProfile =
    draft.profile === "ramp"
      ? { kind: "ramp", duration_ms: Number(draft.durationMs) }
      : draft.profile === "intermittent"
        ? { kind: "intermittent", period_ms: Number(draft.periodMs), duty: Number(draft.duty) }
        : { kind: "step" };
  const command: Command = { fault, severity: Number(draft.severity), profile };
  if (Object.keys(draft.parameters).length > 0) command.parameters = draft.parameters;
  if (draft.moment === "at") return { ...command, at_ms: Number(draft.atMs) };
  if (draft.moment === "when") return { ...command, when: conditionText(draft.when) };
  return command;
}

/** The severity a draft asks for; a dash while its field holds no number. */
export const draftSeverity = (
  { severity }: Pick<FaultDraft, "severity">,
  scale: SeverityScale,
  unit: string,
): string => (typeof severity === "number" ? severityText(severity, scale, unit) : "–");

/** The group of faults without one, such as faults of other packages. */
const OTHERS = "Others";

/** Blocks under their headings; groups and members come in the order of the catalogue. */
export const groupsOf = <T extends Pick<BlockCard, "group">>(blocks: readonly T[]): [string, T[]][] =>
  groupBy(blocks, ({ group }) => group || OTHERS);
