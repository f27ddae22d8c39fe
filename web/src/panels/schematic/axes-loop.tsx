import { useMemo } from "react";
import type { Bench } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { formatIn } from "../../ui/format";
import { useInstances } from "../card/instances";
import { overridden } from "../controllers/slots";
import { LoopDrawing } from "./loop-drawing";
import { type StageMark, stageMarks } from "./stages";
import {
  PARTNER,
  PARTNER_DRIVEN,
  PARTNER_WIRES,
  TWO_AXES,
  TWO_AXIS_WIRES,
  twoAxisBoxesOf,
  twoAxisSignals,
} from "./two-axis-loop";
import { useActingFaults } from "./use-live-values";

/** The two loops of a gyroscope: the drive loop makes x swing, the sense loop reads the rate from y. */
export function AxesLoop({ axes, slots }: Pick<Bench, "axes" | "slots">) {
  const document = useBench((s) => s.bench?.parameters) ?? {};
  const { block } = useCatalog();
  const list = useInstances();
  const acting = useActingFaults();
  const { drive, sense } = slots;
  const shown = useMemo(() => twoAxisSignals(drive, sense), [drive, sense]);
  const hasPartner = axes.includes("partner_x");
  const drivesPartner = hasPartner && block("control", drive)?.outputs.some((port) => port.name === "partner_x");
  const title = (id: string) => {
    const instance = list.find((i) => i.id === id);
    return instance ? (block(instance.family, instance.name)?.title ?? instance.name.replaceAll("_", " ")) : "none";
  };
  const stage = String((document.drive as { kind?: string } | undefined)?.kind ?? "held");
  const what: Record<string, [card: string, kind: string]> = {
    pick_x: ["sensor", "displacement"],
    drive: [`controllers.${drive}`, title(`controllers.${drive}`)],
    force_x: ["drive", stage],
    rate: ["rate", title("rate")],
    plant: ["plant", hasPartner ? "Gyroscope" : title("plant")],
    partner: ["plant", "Gyroscope"],
    pick_y: ["sensor", "displacement"],
    sense: [`controllers.${sense}`, title(`controllers.${sense}`)],
    force_y: ["drive", stage],
  };
  const { drive: late, sensor: sampled } = stageMarks(document);
  const stages: Record<string, StageMark | undefined> = {
    pick_x: sampled,
    pick_y: sampled,
    force_x: late,
    force_y: late,
  };
  const faulted = new Set(acting.flatMap((fault) => twoAxisBoxesOf(fault.shows)));
  const taken = overridden("drive", slots, block);
  return (
    <LoopDrawing
      label="Signal flow around the drive loop and the sense loop"
      boxes={(hasPartner ? [...TWO_AXES, PARTNER] : TWO_AXES).map((box) => ({
        ...box,
        card: what[box.id][0],
        kind: what[box.id][1],
        faulty: faulted.has(box.id),
        stage: stages[box.id],
        waits: box.id === "drive" && taken !== undefined,
      }))}
      wires={[...TWO_AXIS_WIRES, ...(hasPartner ? PARTNER_WIRES : []), ...(drivesPartner ? [PARTNER_DRIVEN] : [])]}
      shown={shown}
      say={(box, value) => (box === "plant" ? formatIn(value, "°", 3) : undefined)}
      faults={{
        titles: acting.map((fault) => fault.title),
        arrows: faulted.has("plant") ? ["M236 112 H224"] : [],
        at: hasPartner ? undefined : [241, 102],
      }}
    />
  );
}
