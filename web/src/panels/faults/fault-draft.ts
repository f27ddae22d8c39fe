import type { Command, FaultProfile } from "../../api/types";

export interface FaultDraft {
  severity: number;
  profile: FaultProfile["kind"];
  durationMs: number;
  periodMs: number;
  duty: number;
  moment: "now" | "at" | "when";
  atMs: number;
  when: string;
}

export function newDraft(severity: number): FaultDraft {
  return {
    severity,
    profile: "step",
    durationMs: 5,
    periodMs: 2,
    duty: 0.5,
    moment: "now",
    atMs: 0,
    when: "plant.displacement > 2",
  };
}

/** The command that does what the form says. */
export function injectCommand(fault: string, draft: FaultDraft): Command {
  const profile: FaultProfile =
    draft.profile === "ramp"
      ? { kind: "ramp", duration_ms: draft.durationMs }
      : draft.profile === "intermittent"
        ? { kind: "intermittent", period_ms: draft.periodMs, duty: draft.duty }
        : { kind: "step" };
  const command: Command = { kind: "inject", fault, severity: draft.severity, profile };
  if (draft.moment === "at") return { ...command, at_ms: draft.atMs };
  if (draft.moment === "when") return { ...command, when: draft.when };
  return command;
}
