import type { Signal } from "../../api/types";
import { formatShort } from "../../ui/format";
import { groupBy } from "../../ui/group-by";

/** A signal goes above or below a level, in the unit of the signal. */
export interface Condition {
  /** Empty: none was chosen. */
  signal: string;
  above: boolean;
  level: number | string;
}

type Named = Pick<Signal, "name" | "unit">;

/** The condition as the server takes it. */
export const conditionText = ({ signal, above, level }: Condition): string => `${signal} ${above ? ">" : "<"} ${level}`;

/** A condition as the server has it, in words and with its unit. */
export function conditionWords(text: string, signals: readonly Named[]): string {
  const [, name, sign, level] = /^(\S+) ([<>]) (\S+)$/.exec(text) ?? [];
  if (!name) return text;
  const unit = signals.find((s) => s.name === name)?.unit ?? "";
  return `${signalWords(name)} ${sign} ${formatShort(Number(level), unit, 6)}`;
}

/** Signals to choose from, by their block. */
export function signalGroups(signals: readonly Pick<Signal, "name">[]) {
  return groupBy(signals, ({ name }) => name.split(".")[0]).map(([block, own]) => ({
    group: spaced(block),
    items: own.map(({ name }) => ({ value: name, label: signalWords(name) })),
  }));
}

const spaced = (text: string) => text.replaceAll("_", " ");

/** "plant.displacement" reads "plant displacement". */
const signalWords = (name: string): string => spaced(name).replaceAll(".", " ");
