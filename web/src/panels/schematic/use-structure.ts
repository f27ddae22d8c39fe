import { useMemo } from "react";
import type { Document } from "../../api/types";
import { useBench } from "../../stream/bench-store";
import { parameterValue, useInstances } from "../card/instances";
import { type Structure, structureOf } from "./structure";

/** How the loop of the bench is drawn now. */
export function useStructure(): Structure {
  const parameters = useBench((s) => s.bench?.parameters);
  const controller = useBench((s) => s.bench?.controller) ?? "";
  const hasDiagnoser = useBench((s) => Object.keys(s.bench?.diagnosers ?? {}).length > 0);
  const list = useInstances();
  return useMemo(() => {
    const document: Document = parameters ?? {};
    const value = (id: string, name: string) => {
      const instance = list.find((i) => i.id === id);
      return instance && parameterValue(document, instance, name);
    };
    return structureOf({
      controller,
      augments: value(`controllers.${controller}`, "augment") !== false,
      sensor: list.find((i) => i.id === "sensor")?.name ?? "",
      light: String(value("sensor", "light") ?? "through_wafer"),
      hasDiagnoser,
      hasIdentifier: list.some((i) => i.family === "identify"),
    });
  }, [parameters, controller, hasDiagnoser, list]);
}
