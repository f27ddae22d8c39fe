import { showPanel } from "../../bench/dock";
import { useView } from "../../bench/view-store";
import { ArrowHead } from "./arrow-head";
import { BOX, DRAWING, type DrawnBox, faultLines, type Wire } from "./loop";
import { pressable } from "./pressable";
import styles from "./schematic.module.css";
import { useLiveValues } from "./use-live-values";

interface LoopDrawingProps {
  label: string;
  boxes: readonly DrawnBox[];
  wires: readonly Wire[];
  /** Signals with newest values in the boxes, by box. */
  shown: Record<string, string>;
  /** The words of a value, in place of a number with its unit. */
  say?: (box: string, value: number) => string | undefined;
  /** Names of the acting faults, arrows from there to the faulty boxes, and the place of the names. */
  faults: { titles: readonly string[]; arrows: readonly string[]; at: [number, number] | undefined };
}

/** A loop with what flows in it now; a box opens its card. */
export function LoopDrawing({ label, boxes, wires, shown, say, faults }: LoopDrawingProps) {
  const card = useView((s) => s.card);
  const live = useLiveValues(shown, say);
  const open = (id: string | undefined) => {
    if (!id) return;
    useView.setState({ card: id });
    showPanel("card");
  };
  return (
    // biome-ignore lint/a11y/useSemanticElements: boxes of a drawing
    <svg viewBox={`0 0 ${DRAWING.width} ${DRAWING.height}`} className={styles.drawing} role="group" aria-label={label}>
      <ArrowHead />
      {wires.map((wire) => (
        <g key={wire.id}>
          {wire.acts && <title>{wire.acts}</title>}
          <path d={wire.d} className={styles.wire} data-acts={wire.acts !== undefined} markerEnd="url(#arrow)" />
          <text x={wire.at[0]} y={wire.at[1]} className={styles.wireName} data-acts={wire.acts !== undefined}>
            {wire.label}
          </text>
        </g>
      ))}
      {faults.titles.length > 0 && faults.at && (
        <g className={styles.fault}>
          <title>{faults.titles.join(", ")}</title>
          {faults.arrows.map((d) => (
            <path key={d} d={d} markerEnd="url(#arrow)" />
          ))}
          {faultLines(faults.titles).map((line, i) => (
            <text key={line} x={faults.at?.[0]} y={(faults.at?.[1] ?? 0) + 14 * i}>
              {shorten(line)}
            </text>
          ))}
        </g>
      )}
      {boxes.map((box) => (
        <g
          key={box.id}
          {...pressable(() => open(box.card))}
          className={styles.box}
          data-chosen={box.card !== undefined && box.card === card}
          data-faulty={box.faulty}
          data-waits={box.waits}
          transform={`translate(${box.x} ${box.y})`}
        >
          <title>{`${box.title} ${box.kind}${box.stage ? `, ${box.stage.words}` : ""}: show its equations and parameters`}</title>
          <rect width={BOX.width} height={BOX.height} rx="5" />
          <text x="6" y="15" className={styles.role}>
            {box.title}
          </text>{" "}
          {box.stage && (
            <text x={BOX.width - 6} y="15" textAnchor="end" className={styles.stage}>
              {box.stage.mark}
            </text>
          )}
          <text x="6" y="31" className={styles.kind}>
            {shorten(box.kind)}
          </text>
        </g>
      ))}
      {boxes.map((box) => (
        <text
          key={box.id}
          x={box.x + BOX.width - 6}
          y={box.y + 49}
          textAnchor="end"
          className={`${styles.value} ${box.says ? styles.verdict : ""}`}
          ref={box.id in shown ? live(box.id) : undefined}
        >
          {cut(box.says ?? "", MOST_SAID)}
        </text>
      ))}
    </svg>
  );
}

/** Letters of a verdict with room in a box. */
const MOST_SAID = 15;

const cut = (text: string, most: number) => (text.length > most ? `${text.slice(0, most - 1).trimEnd()}…` : text);

/** Letters of a title with room in a box. */
const MOST_TITLE = 14;

/** A title for a box: without its brackets, or the acronym in them where the words have no room. */
function shorten(title: string): string {
  const words = title.replace(/\s*\(.*\)$/, "");
  const acronym = /\(([A-Z]+)\)$/.exec(title)?.[1];
  return acronym && words.length > MOST_TITLE ? acronym : cut(words, MOST_TITLE);
}
