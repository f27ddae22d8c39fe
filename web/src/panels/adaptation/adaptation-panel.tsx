import { Button, NativeSelect } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import { useMay } from "../../api/me";
import type { BlockCard, Document } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { actions } from "../../bench/actions";
import { useView } from "../../bench/view-store";
import type { Box, Look, Pen } from "../../picture/pen";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { LaneCanvas, type LaneShown } from "../lanes/lane-canvas";
import { LaneTools } from "../lanes/lane-tools";
import { useLaneTime } from "../lanes/use-lane-time";
import styles from "./adaptation.module.css";
import { adaptiveUnits, signalsOf } from "./adaptation-strips";
import { ExcitationMeter } from "./excitation-meter";
import { AXIS_PX, gutter, paintStrips, RIGHT_PX, STRIP_PX, stripsPicture } from "./paint-strips";

const LEGEND = [{ name: "now", slot: 1 }];

/** What adapts, against what it should be: gains, V and its derivative, s, errors, and how much the input tells. */
export function AdaptationPanel() {
  const signals = useBench((s) => s.bench?.signals);
  const controller = useBench((s) => s.bench?.controller);
  const controllers = useBench((s) => s.bench?.controllers);
  const parameters = useBench((s) => s.bench?.parameters);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const { blocks } = useCatalog();
  const fontSize = useView((s) => s.fontPx);
  const [windowMs, setWindowMs] = useState(20);
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const time = useLaneTime(windowMs, dtMs);
  const units = useMemo(
    () => adaptiveUnits(signals ?? [], layersOf(parameters, blocks)),
    [signals, parameters, blocks],
  );
  const unit =
    units.find((u) => u.block === wanted) ??
    units.find((u) => u.block === controller) ??
    units.find((u) => controllers?.includes(u.block)) ??
    units[0];
  const names = useMemo(() => unit?.strips.flatMap(signalsOf) ?? [], [unit]);
  const shown = useRef<LaneShown | undefined>(undefined);
  const paint = useMemo(
    () => (pen: Pen, box: Box, now: LaneShown, look: Look) => {
      shown.current = now;
      paintStrips(pen, box, now, unit?.strips ?? [], look);
    },
    [unit],
  );
  if (!unit)
    return (
      <EmptyState title="Nothing adapts on this bench">
        Its controllers have fixed gains and it has no identifier. Gains, their ideal values and Lyapunov's function
        appear here with the next bench that has one.
      </EmptyState>
    );
  const take = () =>
    shown.current &&
    stripsPicture(shown.current, unit.strips, `Adaptation of ${unit.block.replaceAll("_", " ")}`, LEGEND);
  return (
    <section className={`view ${styles.panel}`} aria-label="Adaptation">
      <div className={`row ${styles.bar}`}>
        <NativeSelect
          aria-label="What adapts"
          value={unit.block}
          data={units.map((u) => ({
            value: u.block,
            label: `${u.block.replaceAll("_", " ")}${u.block === controller ? ", drives" : ""}`,
          }))}
          onChange={(e) => setWanted(e.currentTarget.value)}
        />
        <span className={`line ${styles.legend}`}>
          <i data-kind="now" /> now <i data-kind="ideal" /> ideal
        </span>
        <LaneTools time={time} onWindow={setWindowMs} take={take} />
      </div>
      <ExcitationMeter />
      {unit.block !== controller && <Shadow block={unit.block} />}
      <div className={styles.strips} style={{ height: unit.strips.length * STRIP_PX + AXIS_PX }}>
        <LaneCanvas
          label={`${unit.block}: ${unit.strips.map((s) => s.title).join(", ")} over time`}
          signals={names}
          time={time}
          left={gutter(fontSize)}
          right={RIGHT_PX}
          paint={paint}
        />
      </div>
    </section>
  );
}

/** A controller that adapts in the shadow of another may be given the drive. */
function Shadow({ block }: { block: string }) {
  const controllers = useBench((s) => s.bench?.controllers);
  const drives = useMay("drive");
  if (!controllers?.includes(block)) return null;
  return (
    <p className={styles.nometer}>
      {block.replaceAll("_", " ")} runs in shadow: it adapts to the voltage another applies.{" "}
      {drives && (
        <Button size="compact-xs" variant="light" onClick={() => actions.controller(block)}>
          Give it the drive
        </Button>
      )}
    </p>
  );
}

/** Boundary layers by controller: as set, or as the catalogue has them. */
function layersOf(parameters: Document | undefined, blocks: readonly BlockCard[]): Record<string, number> {
  const own = (parameters?.controllers ?? {}) as Record<string, { layer_um?: number }>;
  return Object.fromEntries(
    blocks.flatMap((b) => {
      const usual = b.family === "control" && b.parameters.find((p) => p.name === "layer_um")?.default;
      return typeof usual === "number" ? [[b.name, own[b.name]?.layer_um ?? usual]] : [];
    }),
  );
}
