import { Button, NativeSelect } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import { useMay } from "../../api/me";
import type { BlockCard, Document } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { openVariant } from "../../bench/open-bench";
import { useBusy } from "../../bench/use-busy";
import { PictureMenu, type TakePicture } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { middles, type PanelFrame } from "../../stream/panel-frame";
import { EmptyState } from "../../ui/empty-state";
import { BehaviourPlot, type Drawing } from "./behaviour-plot";
import { drawRegions } from "./paint-regions";
import { drawSets } from "./paint-sets";
import { type Limits, peaks } from "./regions";

const PATH_MS = 20;
const PATH_COLUMNS = 200;

/** A diagnoser that this panel can draw, the signals it is drawn from, and how. */
interface Drawn {
  id: string;
  kind: "sets" | "regions";
  signals: string[];
  columns: number;
  draw(frame: PanelFrame): Drawing | undefined;
}

/** The behaviours of a bank and where the measured output lies, or the regions of performance and where the device is. */
export function BehaviourPanel() {
  const bench = useBench((s) => s.bench?.id);
  const replay = useBench((s) => s.bench?.replay_of);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const parameters = useBench((s) => s.bench?.parameters);
  const signals = useBench((s) => s.bench?.signals);
  const { block } = useCatalog();
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const [busy, during] = useBusy();
  const teaches = useMay("teach");
  const picture = useRef<TakePicture>(null);
  const regions = block("diagnose", "regions");
  const all = useMemo(() => {
    const known = new Set((signals ?? []).map((s) => s.name));
    return Object.entries(diagnosers ?? {}).flatMap(([id, { names }]): Drawn[] => {
      if (known.has(`${id}.consistent.${names[0]}`)) return [setsFrom(id, names)];
      return known.has(`${id}.region`) ? [regionsFrom(id, parameters, regions)] : [];
    });
  }, [diagnosers, parameters, signals, regions]);
  const shown = all.find(({ id }) => id === wanted) ?? all[0];
  const begin = (kind: string, said: string) => {
    void during(() => openVariant({ [`diagnosers.${kind}`]: { kind } }, said));
  };
  if (!shown)
    return (
      <EmptyState
        title="No behaviour to draw"
        action={
          bench &&
          teaches &&
          !replay && (
            <>
              <Button
                variant="filled"
                size="xs"
                loading={busy}
                onClick={() => begin("consistency", "The bench restarts with a test of consistency.")}
              >
                Restart with a test of consistency
              </Button>
              <Button
                size="xs"
                loading={busy}
                onClick={() => begin("regions", "The bench restarts with regions of performance.")}
              >
                Restart with regions of performance
              </Button>
            </>
          )
        }
      >
        A test of consistency draws the behaviour of each hypothesis and where the measured output lies; regions of
        performance draw how far the device is from its healthy motion.
      </EmptyState>
    );
  return (
    <section className="view" aria-label="Behaviour">
      <BehaviourPlot
        key={`${bench} ${shown.id}`}
        title={shown.kind === "sets" ? "Behaviours" : "Regions of performance"}
        signals={shown.signals}
        windowMs={PATH_MS}
        columns={shown.columns}
        draw={shown.draw}
        picture={picture}
      >
        {all.length > 1 && (
          <NativeSelect
            aria-label="Diagnoser drawn"
            value={shown.id}
            data={all.map(({ id }) => ({ value: id, label: id.replaceAll("_", " ") }))}
            onChange={(e) => setWanted(e.currentTarget.value)}
          />
        )}
        <PictureMenu take={() => picture.current?.()} />
      </BehaviourPlot>
    </section>
  );
}

function setsFrom(id: string, names: readonly string[]): Drawn {
  const each = names.flatMap((name) => [`${id}.sine.${name}`, `${id}.cosine.${name}`, `${id}.consistent.${name}`]);
  return {
    id,
    kind: "sets",
    signals: [`${id}.verdict`, ...each],
    columns: 2,
    draw: ({ latest }) =>
      drawSets(
        names.map((name, i) => ({
          name,
          words: hypothesisWords(name),
          from: { x: latest[1 + 3 * i], y: latest[2 + 3 * i] },
          holds: latest[3 + 3 * i] === 1,
        })),
        latest[0],
      ),
  };
}

function regionsFrom(id: string, parameters: Document | undefined, card: BlockCard | undefined): Drawn {
  const own = ((parameters?.diagnosers ?? {}) as Record<string, Record<string, unknown>>)[id] ?? {};
  const value = (name: string) => Number(own[name] ?? card?.parameters.find((p) => p.name === name)?.default);
  const limits: Limits = {
    degraded: value("degraded_above"),
    unacceptable: value("unacceptable_above"),
    danger: value("danger_above"),
    dangerUm: value("danger_um"),
  };
  const tone = Number(own.tone_hz ?? (parameters?.reference as Record<string, unknown> | undefined)?.frequency_hz);
  const columns = tone > 0 ? Math.min(PATH_COLUMNS, Math.ceil((1e3 / tone / PATH_MS) * PATH_COLUMNS)) : 1;
  return {
    id,
    kind: "regions",
    signals: [`${id}.loss`, `${id}.region`, "sensor.displacement"],
    columns: PATH_COLUMNS,
    draw: (frame) => {
      const ends = frame.data.subarray(4 * frame.columns, 6 * frame.columns);
      const low = ends.subarray(0, frame.columns);
      const path = { loss: [...middles(frame, 0)], peakUm: peaks(low, ends.subarray(frame.columns), columns) };
      return Number.isFinite(limits.dangerUm) ? drawRegions(path, frame.latest[1], limits) : undefined;
    },
  };
}
