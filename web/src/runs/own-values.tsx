import { useRef } from "react";
import { api } from "../api/api";
import { useAsked } from "../api/queries";
import type { Run } from "../api/types";
import { useOnScreen } from "../ui/on-screen";
import { HEAD } from "./draft";
import { labelScale, labelText } from "./points";

/** No values of the bench; the seed is beside the scenario already. */
const APART = [...HEAD, "seed", "expect", "printed", "comparator"];

/** A parameter of the block that is chosen; under the name of the block there may be another, which does not count. */
const CHOSEN = /^(controller|sensor)\.(?!kind$)/;

/** The values of a run that differ from its scenario in the library, in words; asked for once they are in sight. */
export function OwnValues({ run }: { run: Run }) {
  const place = useRef<HTMLSpanElement>(null);
  const seen = useOnScreen(place);
  const { answer = "" } = useAsked(seen ? ["own values", run.id] : undefined, async () => {
    const [usual, own] = await Promise.all([api.scenario(run.scenario_id), api.runScenario(run.id)]);
    return ownValues(usual.toml, own);
  });
  return (
    <span ref={place} title={answer}>
      {answer}
    </span>
  );
}

/** The values of a scenario that differ from another, in words: "severity 0.5 → 0.8". */
export function ownValues(usual: string, own: string): string {
  const [before, now] = [valuesOf(usual), valuesOf(own)];
  const words = [...now].flatMap(([path, value]) => {
    const old = before.get(path);
    if (value === old || APART.includes(path.split(".")[0])) return [];
    const { name, unit, shown } = labelScale(path, [old, value]);
    const both = old === undefined ? [value] : [old, value];
    const said = both.map((one) => labelText(one, shown).replaceAll("_", " ")).join(" → ");
    return `${typeof value === "string" ? path.replaceAll(/[._]/g, " ") : name} ${said}${unit && `\u00a0${unit}`}`;
  });
  return words.join(", ");
}

/** The values of a scenario by their paths, from its text, in which the server writes one value on each line. */
function valuesOf(toml: string): Map<string, number | string> {
  const values = new Map<string, number | string>();
  let table = "";
  let list = { name: "", at: -1 };
  const numbered = (path: string) =>
    list.name && path.startsWith(list.name) ? path.replace(list.name, `${list.name}${list.at}.`) : path;
  for (const line of toml.split("\n")) {
    const [, entry, head] = /^(\[?)\[([^\]]+)\]/.exec(line) ?? [];
    const [, key, text] = /^(.+?) = (.+)$/.exec(line) ?? [];
    if (entry) list = { name: `${head}.`, at: list.name === `${head}.` ? list.at + 1 : 0 };
    if (head) table = numbered(`${head}.`);
    else if (key) values.set(table + key, Number.isNaN(Number(text)) ? text.replaceAll('"', "") : Number(text));
  }
  const own = (path: string) => path.replace(CHOSEN, (_, one: string) => `${one}s.${values.get(`${one}.kind`)}.`);
  const found = new Map<string, number | string>();
  for (const [path, value] of values) if (CHOSEN.test(path) || !found.has(path)) found.set(own(path), value);
  return found;
}
