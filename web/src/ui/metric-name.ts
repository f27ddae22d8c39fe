import names from "../../../scenarios/metric_names.json";
import { formatFigure, formatSpread } from "./format";
import { plainScale, roundTo } from "./unit-scale";

// The rules of reports (`scenarios/metric_name.py`); `testing/cases/metric.json` holds both to the same names.

/** Units by the ending that the names of fields have for them. */
const UNITS: Partial<Record<string, string>> = names.units;
const NUMBERED: Partial<Record<string, string>> = names.numbered;
const WORDS: Partial<Record<string, string>> = names.words;

/** How figures of one metric are shown beside each other. */
export interface MetricScale {
  /** The metric in words. */
  name: string;
  /** The unit of the figures shown. */
  unit: string;
  /** Both: "rms error, µm". */
  title: string;
  /** A figure in that unit. */
  shown(value: number): number;
  /** One figure by itself, with its deviation if it has one, in the unit and prefix that suit it. */
  say(mean: number | null | undefined, std?: number): string;
}

/** The scale of some figures: in the unit that the name of their metric ends in, with a prefix where they need one. */
export function metricScale(metric: string, values: readonly (number | null | undefined)[]): MetricScale {
  const { name, unit: own } = partsOf(metric);
  const { factor, unit } = plainScale(
    own,
    values.filter((value) => typeof value === "number"),
  );
  const shown = (value: number) => (factor === 1 ? value : roundTo(value * factor, 12));
  const say: MetricScale["say"] = (mean, std) =>
    std && typeof mean === "number" ? formatSpread(metric, mean, std, own) : formatFigure(metric, mean, 4, own);
  return { name, unit, title: unit ? `${name}, ${unit}` : name, shown, say };
}

/** A metric in words with the unit its name ends in: "control.rms_error_um" reads "rms error, µm". */
export const metricTitle = (metric: string): string => metricScale(metric, []).title;

function partsOf(metric: string): { name: string; unit: string } {
  let pieces = metric.split(".");
  const said: string[] = [];
  if (pieces[0] === "twins" && pieces.length > 2) {
    said.push(pieces[1]);
    pieces = pieces.slice(2);
  }
  let number = "{}";
  if (pieces.length > 1 && names.families.includes(pieces[0])) {
    number = NUMBERED[pieces[0]] ?? number;
    pieces = pieces.slice(1);
  }
  const first = said.length;
  let unit = "";
  for (const piece of pieces) {
    // the number of a step belongs to the word before it
    if (/^\d+$/.test(piece) && said.length > first) said[said.length - 1] += ` ${number.replace("{}", piece)}`;
    else {
      const found = withoutUnit(piece);
      unit = found.unit || unit;
      said.push(found.words);
    }
  }
  return { name: said.join(": "), unit };
}

/** The words of a piece, and the unit its longest ending names: V/µm before µm. */
function withoutUnit(piece: string): { words: string; unit: string } {
  const parts = piece.split("_");
  let start = 1;
  while (start < parts.length && !(parts.slice(start).join("_") in UNITS)) start += 1;
  return {
    words: parts
      .slice(0, start)
      .map((part) => WORDS[part] ?? part)
      .join(" "),
    unit: UNITS[parts.slice(start).join("_")] ?? "",
  };
}
