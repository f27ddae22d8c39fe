import { useMemo, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import type { BlockCard } from "../../api/types";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { formatPercent } from "../../ui/format";
import { BlockEquation } from "../card/block-equation";
import type { Instance } from "../card/instances";
import { insideOf, quantityOf } from "./inside";
import styles from "./inside.module.css";
import { useLiveValues } from "./use-live-values";

/** The inside of a block with what flows in it now; a stage shows its equations below. */
export function InsideDrawing({ instance, block }: { instance: Instance; block: BlockCard }) {
  const [chosen, setChosen] = useState<number | undefined>(undefined);
  const signals = useBench((s) => s.bench?.signals);
  const slots = useBench(useShallow((s) => s.bench?.slots));
  const key = instance.id.slice(instance.id.indexOf(".") + 1);
  const inside = useMemo(
    () => insideOf(block, (name) => quantityOf(name, key, block, slots ?? {}, signals ?? [])),
    [block, key, slots, signals],
  );
  const shown = useMemo(
    () => Object.fromEntries(inside.quantities.flatMap((q) => q.signals.map(({ name }) => [name, name]))),
    [inside],
  );
  const live = useLiveValues(shown, (name, value) =>
    name.startsWith(`${key}.probability.`) ? formatPercent(value) : undefined,
  );
  const stage = chosen === undefined ? undefined : block.structure[chosen];
  if (block.structure.length === 0) return <p>{block.title} does not name its stages.</p>;
  const choose = (number: number) => setChosen(number === chosen ? undefined : number);
  return (
    <>
      <div className={styles.place}>
        {/* biome-ignore lint/a11y/useSemanticElements: stages of a drawing */}
        <svg
          viewBox={`0 0 ${inside.width} ${inside.height}`}
          style={{ width: inside.width, minWidth: 0.93 * inside.width }}
          className={styles.drawing}
          role="group"
          aria-label={`Stages of ${block.title}`}
        >
          <defs>
            <marker id="into" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">
              <path d="M0 0.5 L8 4 L0 7.5 Z" className={styles.head} />
            </marker>
          </defs>
          {inside.lines.map(({ id, d, enters }) => (
            <path key={id} d={d} className={styles.line} markerEnd={enters ? "url(#into)" : undefined} />
          ))}
          {inside.quantities.map((quantity) => (
            <g key={quantity.name} transform={`translate(${quantity.x} ${quantity.y})`} className={styles.quantity}>
              <text x={quantity.width / 2} y="12" textAnchor="middle" className={styles.name}>
                {quantity.name}
              </text>
              {quantity.signals.map(({ label, name }, row) => (
                <g key={name} transform={`translate(0 ${15 * (row + 1) + 12})`}>
                  {label && (
                    <text x="4" className={styles.label}>
                      <title>{hypothesisWords(label)}</title>
                      {label}
                    </text>
                  )}
                  <text
                    x={label ? quantity.width - 4 : quantity.width / 2}
                    textAnchor={label ? "end" : "middle"}
                    className={styles.value}
                    ref={live(name)}
                  />
                </g>
              ))}
              {quantity.more > 0 && (
                <text x="4" y={15 * (quantity.signals.length + 1) + 12} className={styles.label}>
                  and {quantity.more} more
                </text>
              )}
            </g>
          ))}
          {inside.stages.map(({ title, stage: number, x, y, width, height }) => (
            // biome-ignore lint/a11y/useSemanticElements: SVG has no button
            <g
              key={title}
              role="button"
              tabIndex={0}
              aria-pressed={number === chosen}
              className={styles.stage}
              transform={`translate(${x} ${y})`}
              onClick={() => choose(number)}
              onKeyDown={(event) => {
                if (event.key !== "Enter" && event.key !== " ") return;
                event.preventDefault();
                event.stopPropagation();
                choose(number);
              }}
            >
              <rect width={width} height={height} rx="5" />
              <text x={width / 2} y="19" textAnchor="middle">
                {title}
              </text>
            </g>
          ))}
        </svg>
      </div>
      {stage && (
        <section className={styles.equations} aria-label={`Equations: ${stage.title}`} aria-live="polite">
          <h3>{stage.title}</h3>
          {stage.equations.map((equation) => (
            <BlockEquation key={equation.label} equation={equation} />
          ))}
          {stage.equations.length === 0 && <p>The text gives this stage no equation of its own.</p>}
        </section>
      )}
    </>
  );
}
