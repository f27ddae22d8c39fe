import type { BlockCard, Command, FaultProfile, Parameter } from "../../api/types";

export interface FaultDraft {
  severity: number;
  profile: FaultProfile["kind"];
  durationMs: number;
  periodMs: number;
  duty: number;
  moment: "now" | "at" | "when";
  atMs: number;
  when: string;
  /** What else the fault lets one choose, as far as it was chosen. */
  parameters: Record<string, unknown>;
}

const SHARED = ["severity", "profile", "start_tick"];

/** The parameters that are a fault's own. */
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
    when: "plant.displacement > 2",
    parameters: {},
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
  if (Object.keys(draft.parameters).length > 0) command.parameters = draft.parameters;
  if (draft.moment === "at") return { ...command, at_ms: draft.atMs };
  if (draft.moment === "when") return { ...command, when: draft.when };
  return command;
}
