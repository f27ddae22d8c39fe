import { useRef, useState } from "react";
import { fits } from "../api/fits";
import type { BlockCard, Document } from "../api/types";
import { useCatalog } from "../api/use-catalog";
import { useBench } from "../stream/bench-store";
import { send } from "./send";

/** The ideal sensor sees the true displacement. */
export const BYPASS = "ideal";

/** Whether a sensor gives a displacement, so that a controller can be fed by it. */
export const feeds = (sensor: BlockCard) => sensor.outputs.some((port) => port.name === "displacement");

/** The sensor that feeds the controllers, all sensors of the bench, and how to use another. */
export function useSensor() {
  const chosen = useBench((s) => (s.bench?.parameters.sensor as Document | undefined)?.kind);
  const axes = useBench((s) => s.bench?.axes) ?? [];
  const { blocks } = useCatalog();
  // The last choice counts until the board has answered: the next click is meant from there.
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const choice = useRef(0);
  const sensors = blocks.filter((b) => b.family === "sense" && fits(b, axes));
  const use = async (name: string) => {
    choice.current += 1;
    const own = choice.current;
    setWanted(name);
    await send({ set: { "sensor.kind": name } }, `Sensor: ${sensors.find((b) => b.name === name)?.title ?? name}`);
    if (own === choice.current) setWanted(undefined);
  };
  return { kind: wanted ?? String(chosen ?? BYPASS), sensors, use };
}
