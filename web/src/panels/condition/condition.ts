import type { Signal } from "../../api/types";
import { formatShort } from "../../ui/format";

/** When something is to happen: a signal goes above or below a level, in the unit of the signal. */
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

/** Signals to choose from, by the block they come from. */
export function signalGroups(signals: readonly Pick<Signal, "name">[]) {
  const groups = new Map<string, { value: string; label: string }[]>();
  for (const { name } of signals) {
    const block = name.split(".")[0];
    const item = { value: name, label: signalWords(name) };
    groups.set(block, [...(groups.get(block) ?? []), item]);
  }
  return [...groups].map(([block, items]) => ({ group: spaced(block), items }));
}

const spaced = (text: string) => text.replaceAll("_", " ");

/** "plant.displacement" reads "plant displacement". */
export const signalWords = (name: string): string => spaced(name).replaceAll(".", " ");
