import { Box, Group, Switch, TextInput } from "@mantine/core";
import { IconSearch } from "@tabler/icons-react";
import { memo, useDeferredValue, useEffect, useMemo, useRef, useState } from "react";
import { useCatalog } from "../api/use-catalog";
import { openPlace, useView } from "../bench/view-store";
import { EquationDetail } from "../ui/equation-detail";
import { formatCount } from "../ui/format";
import { Formula } from "../ui/formula";
import styles from "./equation-index.module.css";
import { type Entry, entriesOf, found } from "./equations";

/** Every equation that runs here, and the printed one if the two differ. */
export function EquationIndex() {
  const { blocks } = useCatalog();
  const asked = useView((s) => s.item);
  const [errataOnly, setErrataOnly] = useState(false);
  const entries = useMemo(() => entriesOf(blocks), [blocks]);
  const families = useMemo(() => found(entries, asked, errataOnly), [entries, asked, errataOnly]);
  const listed = families.flatMap((family) => family.entries);
  const errata = listed.filter(({ equation }) => equation.printed).length;
  const section = useRef<HTMLElement>(null);
  const isFilled = listed.length > 0;
  useEffect(() => {
    if (isFilled && useView.getState().item) section.current?.scrollIntoView();
  }, [isFilled]);
  return (
    <section ref={section} className="card essay" aria-label="Equations">
      <Group component="header" gap="8px 16px">
        <Box flex="1 1 220px">
          <h2>Equations</h2>
          <Box component="p" c="dimmed" fz="sm" role="status">
            {errataOnly
              ? `${formatCount(listed.length, "equation")} with errata`
              : `${formatCount(listed.length, "equation")}, ${errata} of them with errata`}
          </Box>
        </Box>
        <TextInput
          flex="0 1 320px"
          aria-label="Search equations"
          placeholder="Name, section or word: 5.2.4, gain, MRAC"
          leftSection={<IconSearch size={15} />}
          value={asked}
          onChange={(e) => openPlace("theory", e.currentTarget.value, true)}
        />
        <Switch
          size="sm"
          label="Errata only"
          checked={errataOnly}
          onChange={(e) => setErrataOnly(e.currentTarget.checked)}
        />
      </Group>
      {isFilled && <Families families={families} />}
      {blocks.length > 0 && listed.length === 0 && (
        <Box component="p" c="dimmed">
          No equation has all these words.
        </Box>
      )}
    </section>
  );
}

/** The first family at once; hundreds of equations are typeset, and the page answers meanwhile. */
function Families({ families }: { families: ReturnType<typeof found> }) {
  return useDeferredValue(families, families.slice(0, 1)).map((family) => (
    <section key={family.name} aria-label={family.name}>
      <Box component="h3" m="16px 0 4px" c="dimmed" fz="sm" tt="capitalize">
        {family.name}
      </Box>
      <ul>
        {family.entries.map((entry, i) => {
          const blocks = entry.blocks.join(", ");
          return (
            <Row
              key={blocks + entry.equation.label + entry.equation.latex}
              entry={entry}
              blocks={blocks === family.entries[i - 1]?.blocks.join(", ") ? "" : blocks}
            />
          );
        })}
      </ul>
    </section>
  ));
}

interface RowProps {
  entry: Entry;
  /** Names of the blocks; empty below an equation of the same blocks. */
  blocks: string;
}

/** An equation; the name of its family is in the heading above it. */
const Row = memo(function Row({ entry: { family, equation }, blocks }: RowProps) {
  return (
    <li className={styles.row} data-more={blocks === ""}>
      <Box display="grid" fz="sm">
        {blocks && <b>{blocks}</b>}
        {equation.label !== family && <span>{equation.label.replaceAll("_", " ")}</span>}
        {equation.source && <small>{equation.source}</small>}
      </Box>
      {equation.printed ? (
        <div className={styles.erratum}>
          <EquationDetail equation={equation} />
        </div>
      ) : (
        <Formula latex={equation.latex} />
      )}
    </li>
  );
});
