import type { Parameter } from "../../api/types";
import { capital } from "../../ui/capital";

/**
 * The title of a parameter: its name without the unit, which the value has.
 *
 * A parameter with its unit as its name has its meaning as its title.
 */
export function parameterTitle({ label, unit, meaning }: Pick<Parameter, "label" | "unit" | "meaning">): string {
  const own = unit === "%" ? "pct" : plain(unit);
  const spellings = own ? [own, plain(unit.replaceAll("/", " per "))] : [];
  if (spellings.includes(label)) return capital(meaning);
  const suffix = spellings.find((spelling) => label.endsWith(` ${spelling}`));
  return capital(suffix ? label.slice(0, -suffix.length - 1) : label);
}

const plain = (unit: string) =>
  unit
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, " ")
    .trim();
