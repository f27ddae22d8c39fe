import { useMemo } from "react";
import { useShallow } from "zustand/react/shallow";
import type { Bench, Document, Signal } from "../../api/types";
import { useBench } from "../../stream/bench-store";

/** A block on the bench: its card in the catalogue, and the place of its values in the document. */
export interface Instance {
  id: string;
  title: string;
  family: string;
  name: string;
  /** Path of its parameters in the scenario document, as commands name them. */
  path: string;
  /** Other places where the document may keep a value, for blocks with several in shadow. */
  also: string[];
}

/** A table of a document, by its path. */
export const section = (document: Document, path: string): Document => {
  let at: unknown = document;
  for (const key of path.split(".")) at = (at as Document | undefined)?.[key];
  return (at ?? {}) as Document;
};

/** A word of a table of a document. */
export const textOf = (document: Document, path: string, key: string, otherwise: string): string =>
  String(section(document, path)[key] ?? otherwise);

/** Value of a parameter of a block on the bench, if the document states it. */
export function parameterValue(document: Document, instance: Instance, parameter: string): unknown {
  const places = [...instance.also, instance.path];
  return places.map((path) => section(document, path)[parameter]).find((value) => value !== undefined);
}

/** Diagnosers of twins have a colon in their names; they are set with the twin. */
const ofTheBoard = (id: string) => !id.includes(":");

/** Every block on a bench that has a card. */
export function instances(
  bench: Pick<Bench, "axes" | "parameters" | "controllers" | "controller" | "diagnosers" | "slots">,
): Instance[] {
  const { parameters } = bench;
  const text = (path: string, key: string, otherwise: string) => textOf(parameters, path, key, otherwise);
  const driving = Object.values(bench.slots).reverse();
  const controllers = [...driving, ...bench.controllers.filter((name) => !driving.includes(name))];
  const isFlat = bench.axes.length === 0;
  const sensor = text("sensor", "kind", isFlat ? "ideal" : "pick_off");
  const single = (id: string, title: string, family: string, name: string): Instance => {
    return { id, title, family, name, path: id, also: [] };
  };
  /** The stages of the board around its converters have one table. */
  const stage = (id: string, title: string): Instance => ({
    ...single(id, title, "board", isFlat ? id : `axis_${id}`),
    path: "board",
  });
  return [
    ...(isFlat
      ? [single("reference", "Reference", "reference", text("reference", "kind", "sine"))]
      : [
          single("rate", "Angular rate", "rate", text("rate", "kind", "constant")),
          single("waveform", "Waveform", "reference", text("waveform", "kind", "constant")),
        ]),
    ...controllers.map((name) => ({
      ...single(`controllers.${name}`, "Controller", "control", name),
      also: name === bench.controller ? ["controller"] : [],
    })),
    single("environment", "Environment", "board", "environment"),
    stage("sampler", "Filter and sampling"),
    single("drive", "Drive", "board", isFlat ? "drive" : "axis_drive"),
    stage("amplifier", "Delay and amplifier"),
    single("plant", "Device", "plant", text("plant", "model", isFlat ? "linear" : "gyroscope")),
    { ...single("sensor", "Sensor", "sense", sensor), also: [`sensors.${sensor}`] },
    ...Object.entries((parameters.identifiers ?? {}) as Record<string, { kind?: string }>).map(([id, { kind = "" }]) =>
      single(`identifiers.${id}`, "Identifier", "identify", kind),
    ),
    ...Object.keys(bench.diagnosers)
      .filter(ofTheBoard)
      .map((id) => single(`diagnosers.${id}`, "Diagnosis", "diagnose", text(`diagnosers.${id}`, "kind", "mmae"))),
    ...(parameters.supervisor ? [single("supervisor", "Supervisor", "supervise", text("supervisor", "kind", ""))] : []),
    ...Object.entries((parameters.readouts ?? {}) as Record<string, { kind?: string }>).map(([id, { kind = "" }]) =>
      single(`readouts.${id}`, "Read-out", "readout", kind),
    ),
    ...(isFlat ? [single("model", "Reference model", "board", "model")] : []),
    single("guard", "Guard", "board", isFlat ? "guard" : "axis_guard"),
  ];
}

/** Blocks with one instance for each axis of a plant with axes: drive.x, drive.y. */
const AT_EACH_AXIS = ["drive", "guard"];

/** The signals of a block on the bench, outputs first; signals of twins belong to the twins. */
export function ownSignals(instance: Instance, signals: readonly Signal[]): Signal[] {
  const key = instance.id.split(".").at(-1) ?? instance.id;
  // a sensor names its own signals by its kind, and the signal for the loop by "sensor"
  const blocks = instance.family === "sense" ? ["sensor", instance.name] : [key, `${key}.score`];
  const stages = AT_EACH_AXIS.includes(key) || instance.family === "sense" ? blocks.map((block) => `${block}.`) : [];
  const belongs = (block: string) => blocks.includes(block) || stages.some((stage) => block.startsWith(stage));
  return signals.filter((s) => belongs(s.block) && !s.name.includes(":"));
}

/** Every block of the bench shown; the same list until one of them changes. */
export function useInstances(): Instance[] {
  const bench = useBench(
    useShallow(({ bench }) =>
      bench
        ? {
            axes: bench.axes,
            parameters: bench.parameters,
            controller: bench.controller,
            controllers: bench.controllers,
            diagnosers: bench.diagnosers,
          }
        : undefined,
    ),
  );
  const slots = useBench(useShallow((s) => s.bench?.slots));
  return useMemo(() => (bench && slots ? instances({ ...bench, slots }) : []), [bench, slots]);
}
