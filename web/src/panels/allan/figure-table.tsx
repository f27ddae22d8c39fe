import type { RateReadout } from "../../api/types";
import { capital, sentence } from "../../ui/capital";
import { formatShort, formatSpread } from "../../ui/format";
import { TableHead } from "../../ui/table-head";
import styles from "./allan.module.css";
import { driftGrade, walkGrade } from "./deviation";

/** Fitted and true noises with their grade, or why the record does not give them yet. */
export function FigureTable({ figures }: { figures: RateReadout["figures"] }) {
  return (
    <table className={styles.table}>
      <TableHead names={["Noise", "Fitted", "Of the rate itself"]} />
      <tbody>
        {figures.map((figure) => (
          <tr key={figure.letter}>
            <th scope="row">
              {capital(figure.name)} <i>{figure.letter}</i>
            </th>
            <td>
              {figure.value === null ? (
                <small>{sentence(figure.reason)}</small>
              ) : (
                <>
                  <b>{formatSpread("", figure.value, figure.error ?? 0, figure.unit)}</b>
                  <br />
                  <small>{gradeOf(figure.letter, figure.value)}</small>
                </>
              )}
            </td>
            <td>{formatShort(figure.true, figure.unit, 3)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function gradeOf(letter: string, value: number): string {
  if (letter === "N") return walkGrade(value);
  return letter === "B" ? driftGrade(value) : "";
}
