import { useMemo } from "react";
import { useCatalog } from "../../api/use-catalog";
import { showPanel } from "../../app/layouts";
import { useView } from "../../app/view-store";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatShort } from "../../ui/format";
import { instances } from "../card/instances";
import { BOX, boxOf, FAULT_ARROWS, faultLines, LOOP, type LoopBox, WIRES } from "./loop";
import styles from "./schematic.module.css";
import { useLiveValues } from "./use-live-values";

/** The loop with what flows in it now; a box opens its card. */
export function SchematicPanel() {
  const parameters = useBench((s) => s.bench?.parameters);
  const controller = useBench((s) => s.bench?.controller);
  const controllers = useBench((s) => s.bench?.controllers);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const faults = useBench((s) => s.bench?.faults);
  const rate = useBench((s) => s.bench?.sample_rate_khz);
  const scores = useBench((s) => s.scores);
  const card = useView((s) => s.card);
  const { block } = useCatalog();

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
  const live = useLiveValues(shown);
  if (!parameters || !controller || !controllers || !diagnosers)
    return <EmptyState title="No bench yet">The loop appears with the bench.</EmptyState>;

  const list = instances({ parameters, controller, controllers, diagnosers });
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
  const acting = faults?.filter((f) => f.severity !== 0) ?? [];
  const faulted = new Set<string>(acting.map((f) => boxOf(block("faults", f.name)?.shows)));
  const titles = acting.map((f) => block("faults", f.name)?.title ?? f.name.replaceAll("_", " "));
  const open = (id: string | undefined) => {
    if (!id) return;
    useView.setState({ card: id });
    showPanel("card");
  };

  return (
    <section className={styles.panel} aria-label="The loop">
      {/* biome-ignore lint/a11y/useSemanticElements: boxes of a drawing */}
      <svg
        viewBox="0 0 348 266"
        className={styles.drawing}
        role="group"
        aria-label="Signal flow from the reference around the loop"
      >
        <defs>
          <marker
            id="arrow"
            viewBox="0 0 8 8"
            refX="7"
            refY="4"
            markerWidth="7"
            markerHeight="7"
            orient="auto-start-reverse"
          >
            <path d="M0 0.5 L8 4 L0 7.5 Z" className={styles.head} />
          </marker>
        </defs>
        {WIRES.map((wire) => (
          <g key={wire.id}>
            <path d={wire.d} className={styles.wire} markerEnd="url(#arrow)" />
            <text x={wire.at[0]} y={wire.at[1]} className={styles.wireName}>
              {wire.label}
            </text>
          </g>
        ))}
        {acting.length > 0 && (
          <g className={styles.fault}>
            <title>{titles.join(", ")}</title>
            {Object.entries(FAULT_ARROWS).map(
              ([box, d]) => faulted.has(box) && <path key={box} d={d} markerEnd="url(#arrow)" />,
            )}
            {faultLines(titles).map((line, i) => (
              <text key={line} x="229" y={212 + 16 * i}>
                {line}
              </text>
            ))}
          </g>
        )}
        {LOOP.map((box) => (
          // biome-ignore lint/a11y/useSemanticElements: SVG has no button
          <g
            key={box.id}
            role="button"
            tabIndex={0}
            className={styles.box}
            data-chosen={cards[box.id] === card}
            data-faulty={faulted.has(box.id)}
            transform={`translate(${box.x} ${box.y})`}
            onClick={() => open(cards[box.id])}
            onKeyDown={(event) => {
              if (event.key !== "Enter" && event.key !== " ") return;
              event.preventDefault();
              event.stopPropagation();
              open(cards[box.id]);
            }}
          >
            <title>{`${box.title} ${kind(box)}: show its equations and parameters`}</title>
            <rect width={BOX.width} height={BOX.height} rx="5" />
            <text x="8" y="16" className={styles.role}>
              {box.title}
            </text>{" "}
            <text x="8" y="33" className={styles.kind}>
              {shorten(kind(box))}
            </text>
          </g>
        ))}
        {LOOP.map((box) => (
          <text
            key={box.id}
            x={box.x + BOX.width - 8}
            y={box.y + 56}
            textAnchor="end"
            className={styles.value}
            ref={box.id in shown ? live(box.id) : undefined}
          >
            {box.id === "diagnosis" ? verdict : ""}
          </text>
        ))}
      </svg>
      <p className={styles.device}>
        {String((parameters.device as { id?: string } | undefined)?.id ?? "device")} ·{" "}
        {rate === undefined ? "" : formatShort(rate, "kHz")}
      </p>
    </section>
  );
}

const shorten = (title: string) => {
  const text = title.replace(/\s*\(.*\)$/, "");
  return text.length > 14 ? `${text.slice(0, 13).trimEnd()}…` : text;
};
