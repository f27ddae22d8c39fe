import type { Bench, LogEntry } from "../../api/types";
import { cardOf } from "../../api/use-catalog";
import type { Change } from "../../bench/change";
import { flagWords } from "../../bench/flag-words";
import { formatNumber, formatPercent } from "../../ui/format";
import { instances } from "../card/instances";
import { namedPath, valueText } from "../sets/named-path";

/** Of a ratio: a smaller difference from 1 is none. */
const ALIKE = 0.005;
/** A larger ratio is one to almost nothing, whose digits say nothing. */
const MANY = 1000;

/** A change in a few words: "Added mass +5 %", "Switch to Direct MRAC", "Sine: amplitude 10 V → 5 V". */
export function changeWords({ events }: Change, bench: Bench | undefined): string {
  if (events[0].kind === "set") return setWords(events[0], events[events.length - 1], bench);
  const said = events.map((event) => {
    if (event.kind === "heal") return healWords(event);
    return event.kind === "switch" ? `Switch to ${flagWords(event)}` : flagWords(event);
  });
  return said.join(", ");
}

function healWords({ old, command }: LogEntry): string {
  const names = Object.keys((old as object | null) ?? {});
  if (names.length > 1 && command && "heal" in command && command.heal === "all") return "All faults healed";
  return `${names.map((name) => cardOf("faults", name)?.title ?? name.replaceAll("_", " ")).join(", ")} healed`;
}

/** From the value before the slider moved to the value at which it rests. */
function setWords(first: LogEntry, last: LogEntry, bench: Bench | undefined): string {
  const before = (first.old ?? {}) as Record<string, unknown>;
  const now = (last.new ?? {}) as Record<string, unknown>;
  const list = bench ? instances(bench) : [];
  const said = Object.keys(now).map((path) => {
    const { block, parameter, unit } = namedPath(path, list, cardOf);
    const head = path.slice(0, path.lastIndexOf("."));
    const place = head.includes(".") ? block : (list.find((one) => one.path === head)?.title ?? block);
    const quantity = path.endsWith(".kind") ? "" : `${parameter.toLowerCase()} `;
    return `${place}: ${quantity}${valueText(before[path], unit)} → ${valueText(now[path], unit)}`;
  });
  return said.join(", ");
}

/** How much larger or smaller a figure became, in words; nothing where one of the two is zero or unknown. */
export function ratioWords(before: number, after: number): string {
  const ratio = after / before;
  if (!(ratio > 0) || !Number.isFinite(ratio)) return "";
  if (Math.abs(ratio - 1) < ALIKE) return "unchanged";
  const word = ratio > 1 ? "larger" : "smaller";
  const times = ratio > 1 ? ratio : 1 / ratio;
  if (times < 2) return `${formatPercent(Math.abs(ratio - 1))} ${word}`;
  if (times > MANY) return `over ${MANY} times ${word}`;
  return `${formatNumber(times, times < 10 ? 1 : 0)} times ${word}`;
}
