import { Button, Group } from "@mantine/core";
import { useCallback } from "react";
import { api } from "../../api/api";
import { useMay } from "../../api/me";
import { usePanelVisible } from "../../api/panel-visible";
import { useAnswer } from "../../api/queries";
import { send } from "../../bench/send";
import { Legend } from "../../picture/legend-list";
import { Painted } from "../../picture/painted";
import type { Box, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { PictureMenu } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatCount, formatIn } from "../../ui/format";
import { useScheme } from "../../ui/use-canvas";
import { RestartButton } from "../restart/restart-button";
import styles from "./allan.module.css";
import { FigureTable } from "./figure-table";
import { allanEntries, paintAllan } from "./paint-allan";

const EVERY_MS = 1000;

/** The noise of the rate that the driving controller estimates, as an Allan plot, while the bench runs. */
export function AllanPanel() {
  const id = useBench((s) => s.bench?.id);
  const readouts = useBench((s) => s.bench?.parameters.readouts) as Record<string, { kind?: string }> | undefined;
  const visible = usePanelVisible();
  const teaches = useMay("teach");
  const name = Object.entries(readouts ?? {}).find(([, { kind }]) => kind === "allan")?.[0];
  if (!id)
    return <EmptyState title="No bench yet">The noise of the rate appears with the bench of a gyroscope.</EmptyState>;
  if (!name)
    return (
      <EmptyState
        title="No Allan read-out on this bench"
        action={
          <RestartButton
            variant="filled"
            size="xs"
            set={{ "readouts.allan.kind": "allan" }}
            said="Bench with an Allan read-out"
          >
            Restart with an Allan read-out
          </RestartButton>
        }
      >
        {teaches
          ? "An Allan deviation gathers the rate from the first tick on, so a new bench starts from tick 0; this bench is kept."
          : "An Allan deviation gathers the rate from the first tick on; the scenario of this bench has no read-out."}
      </EmptyState>
    );
  return visible ? <Readout key={`${id} ${name}`} bench={id} name={name} /> : null;
}

function Readout({ bench, name }: { bench: string; name: string }) {
  const { value: readout, error } = useAnswer(
    ["readout", bench, name],
    () => api.readout(bench, name),
    () => EVERY_MS,
  );
  const scheme = useScheme();
  const drives = useMay("drive");
  const limited = useBench((s) => drives && s.bench?.time_scale !== null && !s.bench?.replay_of);
  const paint = useCallback(
    (pen: Pen, box: Box, look: Look) => readout && paintAllan(pen, box, readout, look),
    [readout],
  );
  const take = (): Picture | undefined =>
    readout && { ...pictureName("Allan deviation"), height: 480, legend: allanEntries("light"), paint };
  return (
    <section className="view" aria-label="Allan deviation">
      <Group gap="6px 12px" p="6px 12px" fz="sm">
        <span>
          {readout
            ? `Record of ${formatIn(readout.record_s, "s", readout.record_s < 100 ? 2 : 0)}`
            : (error?.body.message ?? "Asking")}
        </span>
        <span>Pairs of means begin an eighth of the averaging time apart.</span>
        {limited && (
          <Button
            size="compact-xs"
            variant="light"
            title="The noise needs a long record; the bench can run faster to gather it"
            onClick={() => void send({ kind: "time_scale", value: null }, "As fast as possible")}
          >
            Gather as fast as possible
          </Button>
        )}
        <PictureMenu take={take} />
      </Group>
      <div className={styles.body}>
        <div className={`column ${styles.chart}`}>
          <div style={{ flex: 1, minHeight: 0 }}>
            <Painted
              label={`Allan deviation over ${formatCount(readout?.octaves.length ?? 0, "averaging time")}`}
              paint={paint}
            />
          </div>
          <Legend entries={allanEntries(scheme)} />
        </div>
        {readout && <FigureTable figures={readout.figures} />}
      </div>
    </section>
  );
}
