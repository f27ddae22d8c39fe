import type { Bench, Document } from "../../api/types";

/** A block as it stands on the bench: where the catalogue describes it and where the document keeps its values. */
export interface Instance {
  id: string;
  title: string;
  family: string;
  name: string;
  /** Path of its parameters in the scenario document, as commands name them. */
  path: string;
}

const section = (document: Document, path: string): Document => {
  let at: unknown = document;
  for (const key of path.split(".")) at = (at as Document | undefined)?.[key];
  return (at ?? {}) as Document;
};

/** Value of a field of the bench's document. */
export function valueAt(document: Document, path: string): unknown {
  const dot = path.lastIndexOf(".");
  return section(document, path.slice(0, dot))[path.slice(dot + 1)];
}

/** Every block on a bench that has a card. */
export function instances(bench: Pick<Bench, "parameters" | "controllers" | "controller" | "diagnosers">): Instance[] {
  const { parameters } = bench;
  const text = (path: string, key: string, otherwise: string) => String(section(parameters, path)[key] ?? otherwise);
  const sensor = text("sensor", "kind", "ideal");
  const controllers = [bench.controller, ...bench.controllers.filter((name) => name !== bench.controller)];
  return [
    {
      id: "reference",
      title: "Reference",
      family: "reference",
      name: text("reference", "kind", "sine"),
      path: "reference",
    },
    ...controllers.map((name) => ({
      id: `controllers.${name}`,
      title: "Controller",
      family: "control",
      name,
      path: `controllers.${name}`,
    })),
    { id: "drive", title: "Drive", family: "board", name: "drive", path: "drive" },
    { id: "plant", title: "Device", family: "plant", name: text("plant", "model", "linear"), path: "plant" },
    { id: "sensor", title: "Sensor", family: "sense", name: sensor, path: `sensors.${sensor}` },
    ...Object.keys(bench.diagnosers).map((id) => ({
      id: `diagnosers.${id}`,
      title: "Diagnosis",
      family: "diagnose",
      name: text(`diagnosers.${id}`, "kind", "mmae"),
      path: `diagnosers.${id}`,
    })),
    { id: "model", title: "Reference model", family: "board", name: "model", path: "model" },
    { id: "guard", title: "Guard", family: "board", name: "guard", path: "guard" },
  ];
}
