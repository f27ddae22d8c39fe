import type { BlockCard } from "../../api/types";
import { formatShort } from "../../ui/format";
import type { Instance } from "../card/instances";
import { parameterTitle } from "../card/parameter-title";

type BlockOf = (family: string, name: string) => BlockCard | undefined;

/** The names of a path of a parameter: its block, its own name, its unit. */
export function namedPath(path: string, list: readonly Instance[], block: BlockOf) {
  const at = path.lastIndexOf(".");
  const [head, leaf] = [path.slice(0, at), path.slice(at + 1)];
  const instance = list.find((one) => one.path === head || one.also.includes(head));
  const card = instance && block(instance.family, instance.name);
  const parameter = card?.parameters.find((one) => one.name === leaf);
  const plain = (text: string) => text.replaceAll("_", " ").replaceAll(".", " ");
  return {
    block: card?.title ?? plain(head),
    parameter: parameter ? parameterTitle(parameter) : plain(leaf),
    unit: parameter?.unit ?? "",
  };
}

/** A value in words; the block computes a null value from the bench. */
export function valueText(value: unknown, unit: string): string {
  if (value === null || value === undefined) return "from the bench";
  if (typeof value === "number") return formatShort(value, unit === "1" ? "" : unit);
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value === "string") return value.replaceAll("_", " ");
  return JSON.stringify(value);
}
