import type { Signal } from "../../api/types";
import type { Instance } from "./instances";

/** The signals of a block on the bench, what it puts out first; those of twins belong to the twins. */
export function ownSignals(instance: Instance, signals: readonly Signal[]): Signal[] {
  const key = instance.id.split(".").at(-1) ?? instance.id;
  // a sensor's own signals carry its kind, and what the loop reads of it is called sensor
  const blocks = instance.family === "sense" ? ["sensor", instance.name] : [key, `${key}.score`];
  return signals.filter((s) => blocks.includes(s.block) && !s.name.includes(":"));
}
