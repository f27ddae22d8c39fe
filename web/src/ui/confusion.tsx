import styles from "./confusion.module.css";
import { formatCount, formatNumber, formatPart } from "./format";
import { TableHead } from "./table-head";

interface ConfusionProps {
  title: string;
  names: string[];
  /** Samples by truth (row) and verdict (column). */
  counts: number[][];
}

/** Verdicts over truths: shares of each row, with the right verdicts on the diagonal. */
export function Confusion({ title, names, counts }: ConfusionProps) {
  return (
    <table className={styles.confusion}>
      <caption>{title}: % of samples, truth down, verdict across</caption>
      <TableHead names={["", ...names]} />
      <tbody>
        {names.map((truth, row) => {
          const total = counts[row].reduce((sum, n) => sum + n, 0);
          return (
            <tr key={truth}>
              <th scope="row">{truth}</th>
              {counts[row].map((count, column) => {
                const share = total ? count / total : 0;
                return (
                  <td
                    key={names[column]}
                    data-right={row === column}
                    title={`${formatNumber(count, 0)} of ${formatCount(total, "sample")}`}
                    style={{ "--share": `${Math.round(share * 55)}%` } as React.CSSProperties}
                  >
                    {total ? (count ? formatPart(100 * share, 100, "", 1) : "") : "·"}
                  </td>
                );
              })}
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
