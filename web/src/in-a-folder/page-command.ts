import type { components } from "../api/schema";
import type { Command } from "../api/types";
import type { FileBench } from "../in-a-file/file-bench";
import type { FileCommand, FileEvent } from "../in-a-file/file-document";

type Schemas = components["schemas"];

/** Commands to the time of a bench. */
export type RunCommand =
  | Schemas["Start" | "Pause" | "Step" | "StepPeriod" | "Reset" | "Undo" | "Redo" | "TimeScale"]
  | Schemas["FastForward" | "Seek" | "Loop"];

/** Commands to its board. */
export type BoardCommand = Exclude<Command, RunCommand>;

type Fault = Extract<BoardCommand, { fault: unknown }>;

const NEAR = 1e-9;
const CONDITION = /^\s*(\S+)\s*([<>])\s*(\S+)\s*$/;

/** A command of the page with its moment, as the bench of a file takes it; words where the file has it not. */
export function fileEvent(bench: FileBench, command: BoardCommand): FileEvent {
  const { dt_ms, signals, reserved } = bench.document;
  const { at_ms, at_sample, when } = command as { at_ms?: number; at_sample?: number; when?: string };
  const moment = typeof at_ms === "number" ? Math.round(at_ms / dt_ms) : (at_sample ?? null);
  if (moment !== null && moment < bench.tick)
    throw new Error(`sample ${moment} has passed, the board is at ${bench.tick}`);
  const event: FileEvent = { tick: moment === bench.tick ? null : moment, command: fileCommand(bench, command) };
  if (!when) return event;
  const [, name, sign, threshold] = CONDITION.exec(when) ?? [];
  const place = signals.findIndex((one) => one.name === name);
  if (place < 0 || !Number.isFinite(Number(threshold)))
    throw new Error(`must be '<signal> > <value>' or '<signal> < <value>', got '${when}'`);
  return { ...event, when: [reserved + place, sign === ">" ? 1 : -1, Number(threshold)] };
}

/** The same without its moment. */
function fileCommand(bench: FileBench, command: BoardCommand): FileCommand {
  if ("fault" in command) {
    const variant = variantOf(bench, command);
    return { fault: command.fault, severity: severityOf(bench, command, variant), variant };
  }
  if ("heal" in command) return { heal: command.heal };
  if ("switch" in command) return { switch: command.switch, cold: command.cold ?? false };
  if ("set" in command) return { set: numbersOf(command.set) };
  if ("reset_trip" in command) return { reset_trip: true };
  throw new Error("a bench without a server has no such command");
}

/** The variant of a fault: a step, or the course and the parameters of an event of the scenario. */
function variantOf(bench: FileBench, { fault, profile, parameters = {} }: Fault): number {
  const { variants = [] } = bench.document.faults[fault] ?? {};
  const wanted: Record<string, unknown> = { ...profile };
  const found = variants.findIndex(
    (one) =>
      Object.entries(wanted).every(
        ([name, value]) => (one.parameters.profile as Record<string, unknown>)[name] === value,
      ) && JSON.stringify(one.parameters.parameters) === JSON.stringify(parameters),
  );
  if (found < 0 && variants.length > 0) throw new Error(`without a server ${fault} comes as a step of its usual kind`);
  return Math.max(found, 0);
}

/** The severity, or the severity of the grid from which it differs in its last digits alone. */
function severityOf(bench: FileBench, { fault, severity }: Fault, variant: number): number {
  const { grid = [] } = bench.document.faults[fault]?.variants[variant].dependence ?? {};
  return grid.find((one) => Math.abs(one - severity) <= NEAR * Math.abs(one)) ?? severity;
}

function numbersOf(values: Record<string, unknown>): Record<string, number> {
  const wrong = Object.keys(values).find((path) => typeof values[path] !== "number");
  if (wrong) throw new Error(`${wrong} cannot be set without a server`);
  return values as Record<string, number>;
}
