import type { Bench, Signal } from "../../api/types";
import type { Strip } from "../adaptation/adaptation-strips";

/** One board of an ensemble. */
export interface Board {
  /** Before its signals: empty, or the twin's name and a colon. */
  prefix: string;
  name: string;
  /** The controller that drives in the last slot. */
  controller: string;
  /** The controller that was chosen for the board. */
  chosen: string;
  /** Slot in `TRACE_COLOURS`. */
  slot: number;
}

/** Quantities by which boards are compared. */
export interface Compared {
  title: string;
  /** The ideal value, as a signal and in words. */
  ideal: string;
  against: string;
  /** The value on a board. */
  value(board: Board): string;
  /** Other motions, and efforts. */
  motions: { title: string; signal: string }[];
  efforts: { title: string; signal: string }[];
}

/** Colours of the boards; slot 0 is the ideal value. */
const SLOTS = [1, 2, 4, 3];
/** Most signals in a subscription. */
const MOST_SIGNALS = 32;

type Twin = { controller?: { kind?: string }; slots?: Record<string, string> };
type Twins = Record<string, Twin>;

/** The board and its twins, with the controller of each. */
export function boardsOf({ parameters, controller }: Pick<Bench, "parameters" | "controller">): Board[] {
  const twins = Object.entries((parameters.twins ?? {}) as Twins);
  return [
    { prefix: "", name: "this bench", controller, chosen: controller, slot: SLOTS[0] },
    ...twins.map(([name, own], i) => {
      const last = own.controller?.kind ?? controller;
      return {
        prefix: `${name}:`,
        name: name.replaceAll("_", " "),
        controller: last,
        chosen: own.controller ? last : (Object.values(own.slots ?? {})[0] ?? last),
        slot: SLOTS[i + 1],
      };
    }),
  ];
}

/** A twin for each controller chosen, named after it; one of an earlier slot drives there. */
export function twinsOf(
  controllers: readonly string[],
  earlierSlot: (controller: string) => string | undefined,
): Twins {
  const found: Twins = {};
  for (const kind of controllers) {
    let name = kind;
    for (let i = 2; name in found; i += 1) name = `${kind}_${i}`;
    const slot = earlierSlot(kind);
    found[name] = slot ? { slots: { [slot]: kind } } : { controller: { kind } };
  }
  return found;
}

/** Boards with one displacement are compared by it, gyroscopes by the measured rate. */
export function comparedOn(axes: readonly string[]): Compared {
  if (axes.length === 0)
    return {
      title: "displacement",
      ideal: "model.displacement",
      against: "the reference model",
      value: ({ prefix }) => `${prefix}plant.displacement`,
      motions: [],
      efforts: [{ title: "effort", signal: "drive.voltage" }],
    };
  return {
    title: "rate",
    ideal: "rate.rate",
    against: "the true rate",
    value: ({ prefix, controller }) => `${prefix}${controller}.rate`,
    motions: axes.map((axis) => ({ title: axis, signal: `plant.${axis}` })),
    efforts: axes.map((axis) => ({ title: `force along ${axis}`, signal: `drive.${axis}.force` })),
  };
}

/** Strips that overlay the boards: the compared value, motion and effort; then the adapted values of each board. */
export function comparison(boards: readonly Board[], compared: Compared, signals: readonly Signal[]): Strip[] {
  const known = new Map(signals.map((s) => [s.name, s]));
  const overlay = (title: string, nameOn: (board: Board) => string, ideal?: string): Strip[] => {
    const [first, ...others] = boards.filter((board) => known.has(nameOn(board)));
    if (!first) return [];
    return [
      {
        title,
        unit: known.get(nameOn(first))?.unit ?? "",
        signal: nameOn(first),
        slot: first.slot,
        ideal,
        rivals: others.map((board) => ({ signal: nameOn(board), slot: board.slot })),
      },
    ];
  };
  const strips = [
    ...overlay(compared.title, compared.value, compared.ideal),
    ...[...compared.motions, ...compared.efforts].flatMap(({ title, signal }) =>
      overlay(title, ({ prefix }) => prefix + signal),
    ),
  ];
  let room = MOST_SIGNALS - strips.reduce((sum, s) => sum + 1 + (s.ideal ? 1 : 0) + (s.rivals?.length ?? 0), 0);
  for (const { prefix, controller, name, slot } of boards) {
    const head = `${prefix}${controller}.`;
    for (const signal of signals) {
      if (!signal.name.startsWith(`${head}gain.`) && !signal.name.startsWith(`${head}parameter.`)) continue;
      const rest = signal.name.slice(head.length);
      const ideal = head + rest.replace(/^gain\./, "gain_ideal.").replace(/^parameter\./, "parameter_true.");
      const needs = known.has(ideal) ? 2 : 1;
      if (room < needs) return strips;
      room -= needs;
      strips.push({
        title: `${name}: ${rest.replaceAll("_", " ").replace(".", " ")}`,
        unit: signal.unit,
        signal: signal.name,
        slot,
        ideal: known.has(ideal) ? ideal : undefined,
      });
    }
  }
  return strips;
}
