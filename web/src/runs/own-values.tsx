import type { ChangedValue, Run } from "../api/types";
import { labelScale, labelText } from "./points";

/** The values of a run that differ from its scenario in the library, in words. */
export function OwnValues({ run }: { run: Run }) {
  const words = (run.changed ?? []).map(changeText).join(", ");
  return <span title={words}>{words}</span>;
}

/** A value that a run changes, in words: "severity 0.5 → 0.8". */
export function changeText({ path, before, value }: ChangedValue): string {
  const both = [before, value].flatMap((one) => (one === null ? [] : [typeof one === "boolean" ? String(one) : one]));
  const { name, unit, shown } = labelScale(path, both);
  const said = both.map((one) => labelText(one, shown).replaceAll("_", " ")).join(" → ");
  return `${typeof value === "number" ? name : path.replaceAll(/[._]/g, " ")} ${said}${unit && `\u00a0${unit}`}`;
}
