import { Box, CloseButton, Group, NativeSelect } from "@mantine/core";
import { useState } from "react";
import { api } from "../../api/api";
import { useAsked } from "../../api/queries";
import type { ParameterSet } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { formatCount } from "../../ui/format";
import { TableHead } from "../../ui/table-head";
import { useInstances } from "../card/instances";
import { namedPath, valueText } from "./named-path";
import styles from "./sets.module.css";

interface SetDifferenceProps {
  first: ParameterSet;
  others: readonly ParameterSet[];
  onClose(): void;
}

const BENCH = "bench";

/** Where a set differs from another, or from the bench as it is now. */
export function SetDifference({ first, others, onClose }: SetDifferenceProps) {
  const bench = useBench((s) => s.bench?.id) ?? "";
  const event = useBench((s) => s.bench?.last_event);
  const [other, setOther] = useState(BENCH);
  const { block } = useCatalog();
  const list = useInstances();
  const query = other === BENCH ? { bench } : { other };
  const { answer } = useAsked(["parameter sets", first.id, query, event], () =>
    api.compareParameterSets(first.id, query),
  );
  const options = others.filter(({ id }) => id !== first.id).map(({ id, name }) => ({ value: id, label: name }));
  const second = options.find(({ value }) => value === other)?.label ?? "now";
  return (
    <div className={styles.difference} style={{ borderBottom: "1px solid var(--line)" }}>
      <Group gap="6px 10px" align="end" justify="space-between" p="8px 12px 12px">
        <NativeSelect
          label={`Compare ${first.name} with`}
          value={other}
          data={[{ value: BENCH, label: "the bench now" }, ...options]}
          onChange={(e) => setOther(e.currentTarget.value)}
        />
        <CloseButton aria-label="End the comparison" onClick={onClose} />
      </Group>
      {answer &&
        (answer.rows.length === 0 ? (
          <Box component="p" p="0 12px 12px">
            No difference in {formatCount(answer.same, "value")}.
          </Box>
        ) : (
          <table>
            <caption>
              {formatCount(answer.rows.length, "value")} {answer.rows.length === 1 ? "differs" : "differ"},{" "}
              {answer.same} {answer.same === 1 ? "is" : "are"} the same
            </caption>
            <TableHead names={["Parameter", first.name, second]} />
            <tbody>
              {answer.rows.map((row) => {
                const { block: title, parameter, unit } = namedPath(row.path, list, block);
                return (
                  <tr key={row.path}>
                    <th scope="row" title={row.path}>
                      {parameter} <small>{title}</small>
                    </th>
                    <td>{valueText(row.first, unit)}</td>
                    <td>{valueText(row.second, unit)}</td>
                  </tr>
                );
              })}
            </tbody>
          </table>
        ))}
    </div>
  );
}
