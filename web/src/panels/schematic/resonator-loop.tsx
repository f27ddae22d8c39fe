import { useMemo } from "react";
import type { Bench } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { useInstances } from "../card/instances";
import { boxOf, FAULT_ARROWS, LOOP, type LoopBox, WIRES } from "./loop";
import { LoopDrawing } from "./loop-drawing";
import { useActingFaults } from "./use-live-values";

/** The loop of a device with one displacement. */
export function ResonatorLoop({ controller, diagnosers }: Pick<Bench, "controller" | "diagnosers">) {
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
    }),
    [controller],
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
  const score = diagnoser ? scores[diagnoser] : undefined;
  const verdict =
    typeof score?.winner === "number" ? diagnosers[diagnoser].names[score.winner] : (score?.winner ?? "–");
  const faulted = new Set<string>(acting.map((fault) => boxOf(fault.shows)));
  return (
    <LoopDrawing
      label="Signal flow from the reference around the loop"
      boxes={LOOP.map((box) => ({
        ...box,
        kind: kind(box),
        card: cards[box.id],
        faulty: faulted.has(box.id),
        says: box.id === "diagnosis" ? verdict : undefined,
      }))}
      wires={WIRES}
      shown={shown}
      faults={{
        titles: acting.map((fault) => fault.title),
        arrows: Object.entries(FAULT_ARROWS).flatMap(([box, d]) => (faulted.has(box) ? [d] : [])),
        at: [232, 181],
      }}
    />
  );
}
