import type { Parameter } from "../../api/types";

/** A parameter's name as people read it: the unit stands beside the value, not in the name. */
export function parameterTitle({ label, unit }: Pick<Parameter, "label" | "unit">): string {
  const suffix =
    unit === "%"
      ? "pct"
      : unit
          .toLowerCase()
          .replace(/[^a-z0-9]+/g, " ")
          .trim();
  const bare = suffix && label.endsWith(` ${suffix}`) ? label.slice(0, -suffix.length - 1) : label;
  return bare.charAt(0).toUpperCase() + bare.slice(1);
}
