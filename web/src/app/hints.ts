import { hasAxes } from "../api/fits";
import type { Bench, LogEntry } from "../api/types";
import { cardOf } from "../api/use-catalog";

/** Something to try, and the event that says that it was done. */
interface Hint {
  id: string;
  text: string;
  isDone(event: LogEntry): boolean;
}

/** The introduction to a bench: a description, things to try, and a scenario that shows all of it. */
export interface Hints {
  intro: string;
  /** The sentence after the intro. */
  more: string;
  hints: Hint[];
  guided: { scenario: string; label: string };
  /** Whether a fault can be hidden, to be found. */
  canHide: boolean;
}

type Shown = Pick<Bench, "axes" | "controllers" | "diagnosers" | "record" | "replay_of" | "signals">;

const byHand = ({ actor }: LogEntry) => actor !== "scenario" && actor !== "board";
const found = ({ kind, new: label }: LogEntry) => kind === "recognised" && label !== "healthy";
const sets = ({ command }: LogEntry, table: string) =>
  Boolean(command && "set" in command && Object.keys(command.set).some((path) => path.startsWith(`${table}.`)));

const switched = (event: LogEntry) => event.kind === "switch" && byHand(event);
const SWITCH: Hint = { id: "switch", text: "change the controller", isDone: switched };

const isMass = ({ command }: LogEntry) =>
  Boolean(command && "fault" in command && command.fault === "added_mass" && command.severity > 0);

/** Whether a name belongs to a hypothesis of more mass alone. */
const namesMass = (diagnosers: Shown["diagnosers"], label: unknown) =>
  Object.values(diagnosers).some(({ names, factors }) => {
    const { mass = 1, ...others } = factors[names.indexOf(String(label))] ?? {};
    return mass > 1 && Object.values(others).every((factor) => factor === 1);
  });

/** What to say of a bench; nothing where nothing can be tried. */
export function hintsOf(bench: Shown): Hints | undefined {
  if (bench.replay_of || bench.record) return undefined;
  const diagnosed = Object.keys(bench.diagnosers).length > 0;
  const axes = hasAxes(bench);
  if (!axes && !bench.signals.some((signal) => signal.name === "plant.displacement")) return undefined;
  return {
    intro: axes
      ? "A live gyroscope: a plate swings along x, and turning it pushes it along y."
      : "A live comb resonator: a voltage shakes a plate on thin beams.",
    more: axes
      ? "The controllers read the rate of turn from that."
      : diagnosed
        ? "Diagnosis names its fault: a full lane means it is certain."
        : "",
    hints: axes ? ofAxes(bench) : ofResonator(bench, diagnosed),
    guided: axes
      ? { scenario: "gyro-diagnosis", label: "Run four faults, step by step" }
      : { scenario: "ch5-seven-step", label: "Run the seven steps" },
    canHide: diagnosed,
  };
}

const switchesSense = (event: LogEntry) => {
  const { command } = event;
  return (
    switched(event) && Boolean(command && "switch" in command && cardOf("control", command.switch)?.slot === "sense")
  );
};

function ofAxes({ controllers }: Shown): Hint[] {
  return [
    {
      id: "rate",
      text: "change the angular rate under Controller",
      isDone: (event) => sets(event, "rate") && byHand(event),
    },
    ...(controllers.length > 1
      ? [{ ...SWITCH, text: "let another sense controller read it", isDone: switchesSense }]
      : []),
  ];
}

function ofResonator({ controllers, diagnosers }: Shown, diagnosed: boolean): Hint[] {
  const findsIt = (event: LogEntry) => found(event) && namesMass(diagnosers, event.new);
  return [
    {
      id: "mass",
      text: "inject Added mass +5\u00a0% under Faults",
      isDone: (event) => event.kind === "inject" && isMass(event) && byHand(event),
    },
    ...(diagnosed ? [{ id: "find", text: "watch Diagnosis find it", isDone: findsIt }] : []),
    ...(controllers.length > 1 ? [SWITCH] : []),
  ];
}
