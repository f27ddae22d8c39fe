import type { Parameter } from "../../api/types";

/**
 * A parameter's name as people read it: the unit stands beside the value, not in the name.
 *
 * One whose name is nothing but its unit goes by its meaning.
 */
export function parameterTitle({ label, unit, meaning }: Pick<Parameter, "label" | "unit" | "meaning">): string {
  const suffix = unit === "%" ? "pct" : plain(unit);
  if (suffix && [suffix, plain(unit.replaceAll("/", " per "))].includes(label)) return capital(meaning);
  return capital(suffix && label.endsWith(` ${suffix}`) ? label.slice(0, -suffix.length - 1) : label);
}

const plain = (unit: string) =>
  unit
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, " ")
    .trim();

const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
