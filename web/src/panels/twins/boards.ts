import type { Bench, Signal } from "../../api/types";
import type { Strip } from "../adaptation/adaptation-strips";

/** One board of an ensemble. */
export interface Board {
  /** Before its signals: empty, or the twin's name and a colon. */
  prefix: string;
  name: string;
  controller: string;
  /** Slot in `TRACE_COLOURS`. */
  slot: number;
}

/** Colours of the boards; slot 0 is what should be. */
const SLOTS = [1, 2, 4, 3];
/** What a panel may subscribe to. */
const MOST_SIGNALS = 32;

type Twins = Record<string, { controller?: { kind?: string } }>;

/** The board and its twins, with what drives each. */
export function boardsOf({ parameters, controller }: Pick<Bench, "parameters" | "controller">): Board[] {
  const twins = Object.entries((parameters.twins ?? {}) as Twins);
  return [
    { prefix: "", name: "this bench", controller, slot: SLOTS[0] },
    ...twins.map(([name, own], i) => ({
      prefix: `${name}:`,
      name: name.replaceAll("_", " "),
      controller: own.controller?.kind ?? controller,
      slot: SLOTS[i + 1],
    })),
  ];
}

/** A twin for each controller chosen, named after it. */
export function twinsOf(controllers: readonly string[]): Twins {
  const found: Twins = {};
  for (const kind of controllers) {
    let name = kind;
    for (let i = 2; name in found; i += 1) name = `${kind}_${i}`;
    found[name] = { controller: { kind } };
  }
  return found;
}

/** Strips that overlay the boards: tracking, effort, then whatever each adapts, board by board. */
export function comparison(boards: readonly Board[], signals: readonly Signal[]): Strip[] {
  const known = new Map(signals.map((s) => [s.name, s]));
  const [first, ...others] = boards;
  const overlay = (title: string, name: string, ideal?: string): Strip[] => {
    const signal = known.get(name);
    if (!signal) return [];
    return [
      {
        title,
        unit: signal.unit,
        signal: name,
        slot: first.slot,
        ...(ideal ? { ideal } : {}),
        rivals: others.map(({ prefix, slot }) => ({ signal: prefix + name, slot })).filter((r) => known.has(r.signal)),
      },
    ];
  };
  const strips = [
    ...overlay("displacement", "plant.displacement", "model.displacement"),
    ...overlay("effort", "drive.voltage"),
  ];
  let room = MOST_SIGNALS - strips.reduce((sum, s) => sum + 1 + (s.ideal ? 1 : 0) + (s.rivals?.length ?? 0), 0);
  for (const { prefix, controller, name, slot } of boards) {
    const head = `${prefix}${controller}.`;
    for (const signal of signals) {
      if (!signal.name.startsWith(`${head}gain.`) && !signal.name.startsWith(`${head}parameter.`)) continue;
      const rest = signal.name.slice(head.length);
      const ideal =
        head +
        (rest.startsWith("gain.")
          ? rest.replace("gain.", "gain_ideal.")
          : rest.replace("parameter.", "parameter_true."));
      const needs = known.has(ideal) ? 2 : 1;
      if (room < needs) return strips;
      room -= needs;
      strips.push({
        title: `${name}: ${rest.replaceAll("_", " ").replace(".", " ")}`,
        unit: signal.unit,
        signal: signal.name,
        slot,
        ...(known.has(ideal) ? { ideal } : {}),
      });
    }
  }
  return strips;
}
