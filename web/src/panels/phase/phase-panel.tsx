import { Button, Group, NativeSelect } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useMemo, useRef, useState } from "react";
import { api } from "../../api/api";
import { hasAxes } from "../../api/fits";
import { useMay, useServed } from "../../api/me";
import { usePanelVisible } from "../../api/panel-visible";
import { useAsked } from "../../api/queries";
import type { UnstableRegion } from "../../api/types";
import { send } from "../../bench/send";
import { PictureMenu } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { NumberField } from "../../ui/number-field";
import { TIME_WINDOWS_MS, windowItems } from "../../ui/time-axis";
import { type PhaseShown, phasePicture } from "./paint-phase";
import styles from "./phase.module.css";
import { PhasePlot } from "./phase-plot";
import { mapFits, mapWords } from "./unstable-map";

/** One signal over another, with the map of the unstable region beneath travel and velocity. */
export function PhasePanel() {
  const drives = useMay("drive");
  const served = useServed();
  const signals = useBench((s) => s.bench?.signals);
  const plant = useBench((s) =>
    String((s.bench?.parameters.plant as { model?: string } | undefined)?.model ?? "linear"),
  );
  const isFlat = useBench((s) => !hasAxes(s.bench));
  const [across, setX] = useState<string | undefined>(undefined);
  const [up, setY] = useState<string | undefined>(undefined);
  const x = across ?? (isFlat ? "plant.displacement" : "plant.x");
  const y = up ?? (isFlat ? "plant.velocity" : "plant.x_velocity");
  const [windowMs, setWindowMs] = useState(4);
  const [driveV, setDriveV] = useState(0);
  const painted = useRef<PhaseShown | undefined>(undefined);
  const { map, failed } = useUnstableRegion(driveV);
  if (!signals)
    return (
      <EmptyState title="No bench yet">Displacement over velocity appears as soon as a bench is connected.</EmptyState>
    );

  const names = signals.map((s) => ({ value: s.name, label: s.name.replaceAll("_", " ").replace(".", " · ") }));
  const fits = mapFits(x, y);
  const flat = plant !== "planar" && plant !== "slaved_lateral";
  return (
    <section className={`view ${styles.panel}`} aria-label="Phase plane">
      <Group gap="6px 8px" p="6px 12px">
        <NativeSelect aria-label="Across" value={x} data={names} onChange={(e) => setX(e.currentTarget.value)} />
        <NativeSelect aria-label="Up" value={y} data={names} onChange={(e) => setY(e.currentTarget.value)} />
        <NativeSelect
          w={84}
          aria-label="Length of the trail"
          value={String(windowMs)}
          data={windowItems(TIME_WINDOWS_MS.phase, windowMs)}
          onChange={(e) => setWindowMs(Number(e.currentTarget.value))}
        />
        {!flat && fits.boundary && (
          <Group gap={6} wrap="nowrap" className="note">
            map with the drive held at
            <NumberField
              label="Drive held"
              unit="V"
              value={driveV}
              minimum={-1000}
              maximum={1000}
              onCommit={setDriveV}
            />
          </Group>
        )}
        <PictureMenu take={() => painted.current && phasePicture(painted.current)} />
      </Group>
      <PhasePlot
        x={x}
        y={y}
        windowMs={windowMs}
        map={fits.folds && !flat ? map : undefined}
        fits={fits}
        painted={painted}
      />
      <p className={`${styles.words} ${styles.beside}`}>
        {failed ??
          (!isFlat ? (
            "Rotation of the moving mass about its rest position; no pull-in."
          ) : flat ? (
            <>
              No unstable region: the {plant} plant cannot move sideways. The planar one can.{" "}
              {drives && served && (
                <Button
                  size="compact-xs"
                  variant="light"
                  onClick={() => send({ set: { "plant.model": "planar" } }, "Planar plant")}
                >
                  Use the planar plant
                </Button>
              )}
            </>
          ) : fits.folds ? (
            map ? (
              mapWords(map)
            ) : !served ? (
              "The map of the unstable region needs the server."
            ) : (
              "Working out the unstable region."
            )
          ) : (
            "The unstable region is drawn over a displacement; choose one for the axis across."
          ))}
      </p>
    </section>
  );
}

/** Faults take effect a tick later, and sliders move in steps. */
const SETTLE_MS = 400;

/** The map of the unstable region of the bench as it is now; asked for again when its device, air or faults change. */
function useUnstableRegion(driveV: number): { map: UnstableRegion | undefined; failed: string | undefined } {
  const id = useBench((s) => s.bench?.id);
  const served = useServed();
  const visible = usePanelVisible();
  const now = useBench((s) => {
    const { device, plant, environment } = s.bench?.parameters ?? {};
    const faults = s.bench?.faults.map((f) => [f.name, f.severity]);
    return JSON.stringify([device, plant, environment, faults, (s.bench?.tick ?? 0) > 0]);
  });
  const question = useMemo(() => ({ id, driveV, now }), [id, driveV, now]);
  const [settled] = useDebouncedValue(question, SETTLE_MS);
  const { answer, refusal } = useAsked(served && settled.id && visible ? ["unstable region", settled] : undefined, () =>
    api.unstableRegion(settled.id ?? "", settled.driveV),
  );
  return { map: answer, failed: refusal?.body.message };
}
