import type { BlockCard } from "../../api/types";
import { capital } from "../../ui/capital";

type Card = Pick<BlockCard, "outputs" | "title">;

/** A slot in words: "Drive controller"; where there is one slot only, "Controller". */
export function slotTitle(slot: string): string {
  return slot ? `${capital(slot)} controller` : "Controller";
}

/** The controller of a later slot that drives the axis of a slot, so that this slot waits. */
export function overridden(
  slot: string,
  slots: Record<string, string>,
  block: (family: string, name: string) => Card | undefined,
): Card | undefined {
  const order = Object.keys(slots);
  const axis = firstCommand(block("control", slots[slot]));
  if (!axis) return undefined;
  return order
    .slice(order.indexOf(slot) + 1)
    .map((later) => block("control", slots[later]))
    .find((later) => later?.outputs.some((port) => port.name === axis && port.unit === "uN"));
}

const firstCommand = (card: Card | undefined) => card?.outputs.find((port) => port.unit === "uN")?.name;
