import { NativeSelect } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import type { BlockCard, Document } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { pictureName } from "../../picture/picture";
import { PictureMenu } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { middles, type PanelFrame } from "../../stream/panel-frame";
import { EmptyState } from "../../ui/empty-state";
import { RestartButton } from "../restart/restart-button";
import { BehaviourPlot, type Drawing } from "./behaviour-plot";
import { drawRegions } from "./paint-regions";
import { drawSets } from "./paint-sets";
import { type Limits, peaks } from "./regions";

const PATH_MS = 20;
const PATH_COLUMNS = 200;

/** A diagnoser that this panel can draw, and the signals for its drawing. */
interface Drawn {
  id: string;
  title: string;
  signals: string[];
  columns: number;
  draw(frame: PanelFrame): Drawing | undefined;
}

/** The behaviours of a bank and the measured output, or the regions of performance and the place of the device. */
export function BehaviourPanel() {
  const bench = useBench((s) => s.bench?.id);
  const replay = useBench((s) => s.bench?.replay_of);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const parameters = useBench((s) => s.bench?.parameters);
  const signals = useBench((s) => s.bench?.signals);
  const { block } = useCatalog();
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const drawing = useRef<Drawing | undefined>(undefined);
  const regions = block("diagnose", "regions");
  const all = useMemo(() => {
    const known = new Set((signals ?? []).map((s) => s.name));
    return Object.entries(diagnosers ?? {}).flatMap(([id, { names }]): Drawn[] => {
      if (known.has(`${id}.consistent.${names[0]}`)) return [setsFrom(id, names)];
      return known.has(`${id}.region`) ? [regionsFrom(id, parameters, regions)] : [];
    });
  }, [diagnosers, parameters, signals, regions]);
  const shown = all.find(({ id }) => id === wanted) ?? all[0];
  if (!shown)
    return (
      <EmptyState
        title="No behaviour to draw"
        action={
          bench &&
          !replay && (
            <>
              <RestartWith kind="consistency" what="a test of consistency" variant="filled" />
              <RestartWith kind="regions" what="regions of performance" />
            </>
          )
        }
      >
        A test of consistency draws the behaviour of each hypothesis and the measured output; regions of performance
        draw how far the device is from its healthy motion.
      </EmptyState>
    );
  return (
    <section className="view" aria-label="Behaviour">
      <BehaviourPlot
        key={`${bench} ${shown.id}`}
        title={shown.title}
        signals={shown.signals}
        windowMs={PATH_MS}
        columns={shown.columns}
        draw={shown.draw}
        drawing={drawing}
      >
        {all.length > 1 && (
          <NativeSelect
            aria-label="Diagnoser drawn"
            value={shown.id}
            data={all.map(({ id }) => ({ value: id, label: id.replaceAll("_", " ") }))}
            onChange={(e) => setWanted(e.currentTarget.value)}
          />
        )}
        <PictureMenu take={() => drawing.current && { ...pictureName(shown.title), height: 600, ...drawing.current }} />
      </BehaviourPlot>
    </section>
  );
}

function RestartWith({ kind, what, variant }: { kind: string; what: string; variant?: "filled" }) {
  return (
    <RestartButton
      variant={variant}
      size="xs"
      set={{ [`diagnosers.${kind}`]: { kind } }}
      said={`The bench restarts with ${what}.`}
    >
      Restart with {what}
    </RestartButton>
  );
}

function setsFrom(id: string, names: readonly string[]): Drawn {
  const each = names.flatMap((name) => [`${id}.sine.${name}`, `${id}.cosine.${name}`, `${id}.consistent.${name}`]);
  return {
    id,
    title: "Behaviours",
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
    title: "Regions of performance",
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
