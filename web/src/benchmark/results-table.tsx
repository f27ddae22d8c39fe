import type { Benchmark, BenchmarkRow } from "../api/types";
import { formatNumber, formatPercent } from "../ui/format";
import { TableHead } from "../ui/table-head";
import styles from "./benchmark.module.css";

/** Standard errors to either side of a mean that hold 95 %. */
const WIDE = 1.96;

type Figure = BenchmarkRow["brier"];

interface Column {
  title: string;
  meaning: string;
  say(row: BenchmarkRow): string;
}

const withError = (figure: Figure, decimals: number) =>
  figure ? `${formatNumber(figure.mean, decimals)}\u00a0±\u00a0${formatNumber(WIDE * figure.error, decimals)}` : "–";
const share = (figure: Figure) => (figure ? formatPercent(figure.mean, 1) : "–");

const costText = (cost: Benchmark["costs"][string]) =>
  `${formatNumber(cost.ns_per_sample, 0)} (${formatNumber(cost.over_mmae, 2)})`;

const COLUMNS: Column[] = [
  {
    title: "log score, nat",
    meaning: "Mean of minus the logarithm of the probability of the true class. Less is better.",
    say: (row) => withError(row.log_score, 3),
  },
  {
    title: "Brier score",
    meaning: "Mean squared distance of the probabilities from the truth. Less is better.",
    say: (row) => withError(row.brier, 3),
  },
  {
    title: "delay, samples",
    meaning: "From the fault to the first alarm; a fault that is missed counts with the rest of its case.",
    say: (row) => withError(row.delay_samples, 0),
  },
  { title: "missed", meaning: "Share of faults without any alarm.", say: (row) => share(row.missed) },
  { title: "detection", meaning: "Share of faulty samples with the alarm on.", say: (row) => share(row.detection) },
  {
    title: "false alarm",
    meaning: "Share of healthy samples with the alarm on.",
    say: (row) => share(row.false_alarm),
  },
  {
    title: "isolation",
    meaning: "Share of faulty samples with the alarm on whose most probable fault is the true one.",
    say: (row) => share(row.isolation),
  },
  {
    title: "false switches",
    meaning: "Exits from the truth after it was found, for each case.",
    say: (row) => withError(row.false_switches, 1),
  },
];

const COST =
  "Time per sample, and its ratio to the Kalman bank in the same run, on the machine that computed the table.";

interface Results {
  /** The title of a diagnoser. */
  named(unit: string): string;
  rows: readonly BenchmarkRow[];
  costs: Benchmark["costs"];
  label: string;
}

/** The diagnosers of a track, best first, with the half width of the 95 % intervals. */
export function ResultsTable({ named, rows, costs, label }: Results) {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a region that scrolls is reached by the keyboard
    <section className="wide" aria-label={label} tabIndex={0}>
      <table className={styles.table}>
        <TableHead
          names={[
            "rank",
            "diagnoser",
            ...COLUMNS.map(({ title, meaning }) => [title, meaning] as const),
            ["time, ns", COST],
            "digest",
          ]}
        />
        <tbody>
          {rows.map((row, i) => (
            <tr key={row.unit}>
              <td data-title="rank">{row.log_score ? formatNumber(i + 1, 0) : "–"}</td>
              <th scope="row" title={row.unit}>
                {named(row.unit)}
              </th>
              {COLUMNS.map((column) => (
                <td key={column.title} data-title={column.title}>
                  {column.say(row)}
                </td>
              ))}
              <td data-title="time, ns">{costs[row.unit] ? costText(costs[row.unit]) : "–"}</td>
              <td data-title="digest" title={row.digest}>
                <code>{row.digest.slice(0, 8)}</code>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}
