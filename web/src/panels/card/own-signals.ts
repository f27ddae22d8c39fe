import type { Signal } from "../../api/types";
import type { Instance } from "./instances";

/** Blocks that stand once at each axis of a plant that has some: drive.x, drive.y. */
const AT_EACH_AXIS = ["drive", "guard"];

/** The signals of a block on the bench, what it puts out first; those of twins belong to the twins. */
export function ownSignals(instance: Instance, signals: readonly Signal[]): Signal[] {
  const key = instance.id.split(".").at(-1) ?? instance.id;
  // a sensor's own signals carry its kind, and what the loop reads of it is called sensor
  const blocks = instance.family === "sense" ? ["sensor", instance.name] : [key, `${key}.score`];
  const stages = AT_EACH_AXIS.includes(key) || instance.family === "sense" ? blocks.map((block) => `${block}.`) : [];
  const belongs = (block: string) => blocks.includes(block) || stages.some((stage) => block.startsWith(stage));
  return signals.filter((s) => belongs(s.block) && !s.name.includes(":"));
}
