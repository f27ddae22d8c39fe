import { Box } from "@mantine/core";
import { useMemo, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import type { BlockCard } from "../../api/types";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { formatPercent } from "../../ui/format";
import { BlockEquation } from "../card/block-equation";
import type { Instance } from "../card/instances";
import { ArrowHead } from "./arrow-head";
import { insideOf, quantityOf } from "./inside";
import { pressable } from "./pressable";
import styles from "./schematic.module.css";
import { useLiveValues } from "./use-live-values";

/** The inside of a block with its values now; a stage shows its equations below. */
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
  return (
    <>
      <Box flex="1 1 auto" mih={120} ta="center" style={{ overflow: "auto" }}>
        {/* biome-ignore lint/a11y/useSemanticElements: stages of a drawing */}
        <svg
          viewBox={`0 0 ${inside.width} ${inside.height}`}
          style={{ width: inside.width, minWidth: 0.93 * inside.width, maxWidth: "100%", height: "auto" }}
          role="group"
          aria-label={`Stages of ${block.title}`}
        >
          <ArrowHead />
          {inside.lines.map(({ id, d, enters }) => (
            <path
              key={id}
              d={d}
              className={styles.wire}
              style={{ strokeWidth: 1.2 }}
              markerEnd={enters ? "url(#arrow)" : undefined}
            />
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
                    className={styles.quantityValue}
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
            <g
              key={title}
              {...pressable(() => setChosen(number === chosen ? undefined : number), number === chosen)}
              className={styles.box}
              transform={`translate(${x} ${y})`}
            >
              <rect width={width} height={height} rx="5" />
              <text x={width / 2} y="19" textAnchor="middle" className={styles.kind}>
                {title}
              </text>
            </g>
          ))}
        </svg>
      </Box>
      {stage && (
        <Box
          component="section"
          flex="none"
          mah="45%"
          m="4px 0"
          p={4}
          style={{ borderTop: "1px solid var(--line)", overflowY: "auto" }}
          aria-label={`Equations: ${stage.title}`}
          aria-live="polite"
        >
          <Box component="h3" m="4px 0">
            {stage.title}
          </Box>
          {stage.equations.map((equation) => (
            <BlockEquation key={equation.label} equation={equation} />
          ))}
          {stage.equations.length === 0 && <p className="note">The text gives this stage no equation of its own.</p>}
        </Box>
      )}
    </>
  );
}
