import { useMemo } from "react";
import type { Bench } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { useInstances } from "../card/instances";
import { boxOf, FAULT_ARROWS, type LoopBox } from "./loop";
import { LoopDrawing } from "./loop-drawing";
import { type StageMark, stageMarks } from "./stages";
import type { Structure } from "./structure";
import { useActingFaults } from "./use-live-values";

interface ResonatorLoopProps extends Pick<Bench, "controller" | "diagnosers"> {
  structure: Structure;
}

/** The loop of a device with one displacement. */
export function ResonatorLoop({ controller, diagnosers, structure }: ResonatorLoopProps) {
  const parameters = useBench((s) => s.bench?.parameters) ?? {};
  const scores = useBench((s) => s.scores);
  const { block } = useCatalog();
  const list = useInstances();
  const acting = useActingFaults();
  const shown = useMemo(
    () => ({
      reference: "reference.voltage",
      controller: `${controller}.voltage`,
      drive: "drive.voltage",
      plant: "plant.displacement",
      sensor: "sensor.displacement",
      model: "model.displacement",
      ...Object.fromEntries(structure.extra.flatMap(({ id, signal }) => (signal ? [[id, signal]] : []))),
    }),
    [controller, structure],
  );
  const diagnoser = Object.keys(diagnosers)[0];
  const identifier = Object.keys((parameters.identifiers as object | undefined) ?? {})[0];
  const cards: Record<LoopBox["id"], string | undefined> = {
    reference: "reference",
    controller: `controllers.${controller}`,
    drive: "drive",
    plant: "plant",
    sensor: "sensor",
    diagnosis: diagnoser && `diagnosers.${diagnoser}`,
    model: "model",
    identifier: identifier && `identifiers.${identifier}`,
  };
  const kind = (box: LoopBox) => {
    if (box.id === "model") return String((parameters.model as { kind?: string } | undefined)?.kind ?? "copy");
    const instance = list.find((i) => i.id === cards[box.id]);
    return instance ? (block(instance.family, instance.name)?.title ?? instance.name.replaceAll("_", " ")) : "none";
  };
  const stages: Partial<Record<LoopBox["id"], StageMark>> = stageMarks(parameters);
  const score = diagnoser ? scores[diagnoser] : undefined;
  const verdict =
    typeof score?.winner === "number" ? diagnosers[diagnoser].names[score.winner] : (score?.winner ?? "–");
  const faulted = new Set<string>(acting.map((fault) => boxOf(fault.shows)));
  return (
    <LoopDrawing
      label={`Signal flow from the reference around the loop${structure.figure ? `, as in figure ${structure.figure}` : ""}`}
      boxes={[
        ...structure.boxes.map((box) => ({
          ...box,
          kind: kind(box),
          card: cards[box.id],
          faulty: faulted.has(box.id),
          stage: stages[box.id],
          says: box.id === "diagnosis" ? hypothesisWords(verdict) : undefined,
        })),
        ...structure.extra.map((box) => ({ ...box, card: box.card ?? cards.controller, faulty: false })),
      ]}
      wires={structure.wires}
      shown={shown}
      faults={{
        titles: acting.map((fault) => fault.title),
        arrows: Object.entries(FAULT_ARROWS).flatMap(([box, d]) => (faulted.has(box) ? [d] : [])),
        at: structure.hasRoom ? [structure.figure ? 236 : 232, 181] : undefined,
      }}
    />
  );
}
