import { diagnoserWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { TableHead } from "../../ui/table-head";
import { PARTS, sayRatio, useWeighted } from "../lanes/weighted-estimate";
import { useLiveValues } from "../schematic/use-live-values";
import styles from "./scoreboard.module.css";

/** State and parameters of the device as each diagnoser weighs its models. */
export function WeightedTable({ ids }: { ids: readonly string[] }) {
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const { shown, has } = useWeighted(ids);
  const live = useLiveValues(shown, sayRatio);
  const weighed = ids.filter((id) => has(id, "mass"));
  if (weighed.length === 0) return null;
  return (
    <table className={styles.table}>
      <caption>Models weighted by their probabilities, and parameters over nominal</caption>
      <TableHead names={["Diagnoser", "Displacement", "Velocity", "Mass", "Stiffness", "Damping"]} />
      <tbody>
        {weighed.map((id) => (
          <tr key={id}>
            <th scope="row">{diagnoserWords(id, diagnosers)}</th>
            {["displacement", "velocity"].map((port) => (
              <td key={port}>
                {has(id, port) ? (
                  <>
                    <span ref={live(`${id}.weighted.${port}`)} />
                    <small>
                      ± <span ref={live(`${id}.weighted.${port}_std`)} />
                    </small>
                  </>
                ) : (
                  "–"
                )}
              </td>
            ))}
            {PARTS.map((part) => (
              <td key={part} ref={live(`${id}.weighted.${part}`)} />
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}
