import { Box } from "@mantine/core";
import type { BlockCard, CheckedUnit } from "../../api/types";
import { formatCount, formatNumber, formatShort } from "../../ui/format";
import { Prose } from "../../ui/prose";
import { unitText } from "../../ui/unit-scale";
import { Weaknesses } from "../../ui/weaknesses";
import { BlockEquation } from "../card/block-equation";
import styles from "./editor.module.css";

/** The facts of a unit, as the catalogue would show them. */
export function UnitFacts({ unit: { card, operations, hash } }: { unit: CheckedUnit }) {
  return (
    <>
      <Box component="h2" m="8px 0 4px" fz="lg">
        {card.title}
      </Box>
      <Box component="p" className="note" mb={6}>
        <Prose text={card.summary} />
      </Box>
      <Weaknesses of={card} />
      {card.equations.map((equation) => (
        <BlockEquation key={equation.label + equation.latex} equation={equation} />
      ))}
      <Parameters card={card} />
      <section aria-label="Puts out">
        <h3>Puts out</h3>
        <Ports ports={[...card.outputs, ...card.taps]} />
      </section>
      {card.inputs.length > 0 && (
        <details>
          <summary>Reads {formatCount(card.inputs.length, "signal")}</summary>
          <Ports ports={card.inputs} />
        </details>
      )}
      <Box component="p" className="note" mb={6}>
        At most {formatNumber(operations, 0)} operations a sample. Text <code>{hash.slice(0, 12)}</code>
      </Box>
    </>
  );
}

function Parameters({ card }: { card: BlockCard }) {
  if (card.parameters.length === 0) return null;
  return (
    <section aria-label="Parameters">
      <h3>Parameters</h3>
      <dl className={styles.list}>
        {card.parameters.map(({ name, meaning, unit, default: usual, minimum, maximum }) => (
          <div key={name}>
            <dt>
              <code>{name}</code>
              <small>{meaning}</small>
            </dt>
            <dd>
              {typeof usual === "number" ? formatShort(usual, unit, 6) : usualText(usual)}
              {minimum !== null && maximum !== null && (
                <small>
                  {formatShort(minimum, "", 6)} to {formatShort(maximum, "", 6)}
                </small>
              )}
            </dd>
          </div>
        ))}
      </dl>
    </section>
  );
}

/** A default that is no number, in words; a table or a list is too long for a line. */
function usualText(usual: unknown): string {
  if (usual === null) return "left to the unit";
  return typeof usual === "object" ? "…" : String(usual);
}

function Ports({ ports }: { ports: BlockCard["taps"] }) {
  return (
    <dl className={styles.list}>
      {ports.map(({ name, unit, meaning, labels }) => (
        <div key={name}>
          <dt>
            <code>{name}</code>
            <small>{meaning}</small>
          </dt>
          <dd>{[labels.length > 0 && `${labels.length} of`, unitText(unit)].filter(Boolean).join(" ")}</dd>
        </div>
      ))}
    </dl>
  );
}
