import { Group, Pagination } from "@mantine/core";
import type { PointTally } from "../api/types";
import { formatNumber, formatSpread } from "../ui/format";
import { metricScale } from "../ui/metric-name";
import { labelScale, labelText } from "./points";
import styles from "./runs.module.css";
import { PAGE, type Points } from "./use-points";

interface Column {
  id: string;
  title: string;
  of(point: PointTally): string | number | undefined;
  say(point: PointTally): string;
}

interface PointsTableProps extends Pick<Points, "isPage" | "page" | "setPage" | "order" | "setOrder"> {
  /** All points, or the points of a page in the chosen order. */
  points: PointTally[];
  metrics: string[];
  /** Points on all pages. */
  found: number;
}

/** One row for each point; a click on a heading sorts by it. */
export function PointsTable({ points, metrics, found, isPage, page, setPage, order, setOrder }: PointsTableProps) {
  const axes = [...new Set(points.flatMap((point) => Object.keys(point.labels)))];
  const columns: Column[] = [
    ...axes.map((axis): Column => {
      const { title, shown } = labelScale(
        axis,
        points.map((p) => p.labels[axis]),
      );
      return { id: axis, title, of: (p) => p.labels[axis], say: (p) => labelText(p.labels[axis] ?? "", shown) };
    }),
    { id: "runs", title: "runs", of: (p) => p.runs, say: (p) => formatNumber(p.runs ?? 0, 0) },
    { id: "ok", title: "as expected", of: (p) => p.ok, say: (p) => formatNumber(p.ok ?? 0, 0) },
    { id: "tripped", title: "tripped", of: (p) => p.tripped, say: (p) => formatNumber(p.tripped ?? 0, 0) },
    ...metrics.map((metric): Column => {
      const mean = (p: PointTally) => p.metrics?.[metric]?.mean;
      const { title, shown } = metricScale(metric, points.map(mean));
      return {
        id: metric,
        title,
        of: mean,
        say: (p) => {
          const found = p.metrics?.[metric];
          return found ? formatSpread(metric, shown(found.mean), shown(found.std)) : "–";
        },
      };
    }),
  ];
  const by = columns.find((column) => column.id === order?.id);
  const rows =
    by && !isPage ? [...points].sort((a, b) => compare(by.of(a), by.of(b)) * (order?.down ? -1 : 1)) : points;
  return (
    <>
      <div className="wide">
        <table className={`numbers ${styles.table}`}>
          <thead>
            <tr>
              {columns.map((column) => (
                <th
                  key={column.id}
                  scope="col"
                  aria-sort={column === by ? (order?.down ? "descending" : "ascending") : undefined}
                >
                  <button
                    type="button"
                    title={`Sort by ${column.id}`}
                    onClick={() => setOrder({ id: column.id, down: order?.id === column.id && !order.down })}
                  >
                    {column.title}
                    {column === by && (order?.down ? " ↓" : " ↑")}
                  </button>
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {rows.map((point) => (
              <tr key={JSON.stringify(point.labels)}>
                {columns.map((column) => (
                  <td key={column.id}>{column.say(point)}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      {isPage && (
        <Group justify="space-between" gap="8px 16px" pt={8}>
          <p className="note" role="status">
            Points {formatNumber((page - 1) * PAGE + 1, 0)} to {formatNumber(Math.min(page * PAGE, found), 0)} of{" "}
            {formatNumber(found, 0)}
          </p>
          <Pagination
            size="sm"
            total={Math.ceil(found / PAGE)}
            value={page}
            onChange={setPage}
            getItemProps={(number) => ({ "aria-label": `Page ${number}` })}
            getControlProps={(control) => ({ "aria-label": `${control} page` })}
          />
        </Group>
      )}
    </>
  );
}

function compare(a: string | number | undefined, b: string | number | undefined): number {
  if (a === undefined || b === undefined) return a === b ? 0 : a === undefined ? 1 : -1;
  return typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
}
