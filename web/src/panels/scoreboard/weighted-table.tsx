import { diagnoserWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { TableHead } from "../../ui/table-head";
import { AXES_PARTS, AXES_STATE, PARTS, STATE, sayRatio, useWeighted } from "../lanes/weighted-estimate";
import { useLiveValues } from "../schematic/use-live-values";
import styles from "./scoreboard.module.css";

const WORDS: Record<string, string> = { second_stiffness: "Stiffness of y", x: "x", y: "y" };
const said = (port: string) => WORDS[port] ?? port.charAt(0).toUpperCase() + port.slice(1);

/** State and parameters of the device as each diagnoser weighs its models. */
export function WeightedTable({ ids }: { ids: readonly string[] }) {
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const { shown, has } = useWeighted(ids);
  const live = useLiveValues(shown, sayRatio);
  const weighed = ids.filter((id) => has(id, "mass"));
  if (weighed.length === 0) return null;
  const onAxes = weighed.some((id) => has(id, "rate"));
  const states: readonly string[] = onAxes ? AXES_STATE : STATE;
  const parts: readonly string[] = onAxes ? [...PARTS, ...AXES_PARTS] : PARTS;
  return (
    <table className={styles.table}>
      <caption>Models weighted by their probabilities, and parameters over nominal</caption>
      <TableHead names={["Diagnoser", ...[...states, ...parts].map(said)]} />
      <tbody>
        {weighed.map((id) => (
          <tr key={id}>
            <th scope="row">{diagnoserWords(id, diagnosers)}</th>
            {states.map((port) => (
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
            {parts.map((part) => (
              <td key={part} ref={live(`${id}.weighted.${part}`)} />
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}
