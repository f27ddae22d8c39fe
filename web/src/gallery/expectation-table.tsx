import { useState } from "react";
import type { GalleryCard } from "../api/types";
import { formatShort, keepUnits } from "../ui/format";
import { metricScale } from "../ui/metric-name";
import { Verdict } from "../ui/verdict";
import styles from "./gallery.module.css";

const SHOWN = 3;

type Expected = GalleryCard["expectations"][number];
/** A row; runs kept from earlier lack what has been added since. */
type Entry = Omit<Expected, "fitted" | "reason" | "comparator" | "pid_too" | "expected_words"> & Partial<Expected>;

interface ExpectationTableProps {
  entries: Entry[];
  /** Of the whole; rows that differ from it say their own. */
  verdict: string | null;
}

/** What is said of a figure beside its numbers: why it stands alone, what was chosen for it, where it comes from. */
function remarks(entry: Entry): string[] {
  const fitted = entry.fitted ?? [];
  return [
    ...(entry.note ? [entry.note] : []),
    ...(fitted.length > 0 ? [`chosen so that it agrees: ${fitted.join(", ")}`] : []),
    ...(entry.reason ? [`not compared with the open loop: ${entry.reason}`] : []),
  ];
}

/** An expectation of a run that was kept before they had words: its numbers with their unit, and the signs of print. */
function readable({ metric, expected }: Entry): string {
  const numbers = [...expected.matchAll(NUMBER)].map(([text]) => numberIn(text));
  const { unit, shown } = metricScale(metric, numbers);
  const said = expected.replaceAll(NUMBER, (text) => formatShort(shown(numberIn(text)), unit));
  return said.replaceAll(">= ", "≥\u00a0").replaceAll("<= ", "≤\u00a0");
}

const NUMBER = /[-−]?\d[\d.]*(?:e[+-]?\d+)?/g;
const numberIn = (text: string) => Number(text.replace("−", "-"));

/** Figure by figure what is expected, what was measured, and what the open loop gives; the first few until all are asked for. */
export function ExpectationTable({ entries, verdict }: ExpectationTableProps) {
  const [all, setAll] = useState(false);
  if (entries.length === 0) return <p className={styles.nothing}>This experiment makes no claim.</p>;
  const rows = all ? entries : entries.slice(0, SHOWN);
  const hasOpenLoop = entries.some((entry) => typeof entry.open_loop === "number");
  const hasPid = entries.some((entry) => typeof entry.pid === "number");
  return (
    <div className={styles.figures}>
      <table>
        <thead>
          <tr>
            <th scope="col">figure</th>
            <th scope="col">expected</th>
            <th scope="col">measured</th>
            {hasOpenLoop && (
              <th scope="col" title="The same scenario with the open loop in place of its controller">
                open loop
              </th>
            )}
            {hasPid && (
              <th scope="col" title="The same scenario with a tuned PID in place of its controller">
                PID
              </th>
            )}
          </tr>
        </thead>
        <tbody>
          {rows.map((entry) => {
            const { name, say } = metricScale(entry.metric, []);
            const expected = entry.expected_words ?? readable(entry);
            return (
              <tr key={entry.metric} title={[entry.metric, ...remarks(entry)].join(": ")}>
                <th scope="row">
                  {name}
                  {entry.published && (
                    <small className={styles.published}>published: {entry.published.replaceAll(" %", "\u00a0%")}</small>
                  )}
                  {entry.comparator && (
                    <small className={styles.published}>
                      {entry.comparator}
                      {entry.pid_too && ", meets the claim too"}
                    </small>
                  )}
                  {entry.verdict !== verdict && (
                    <div>
                      <Verdict verdict={entry.verdict} borneOut={entry.ok === true} />
                    </div>
                  )}
                  {all && remarks(entry).map((text) => <small key={text}>{keepUnits(text)}</small>)}
                </th>
                <td>{expected}</td>
                <td className={styles.measured} data-ok={entry.ok}>
                  {say(entry.measured)}
                  {entry.ok === false && " ✗"}
                </td>
                {hasOpenLoop && <td>{say(entry.open_loop)}</td>}
                {hasPid && <td>{say(entry.pid)}</td>}
              </tr>
            );
          })}
        </tbody>
      </table>
      {entries.length > SHOWN || entries.some((entry) => remarks(entry).length > 0) ? (
        <button type="button" className={styles.more} aria-expanded={all} onClick={() => setAll(!all)}>
          {all ? "less" : entries.length > SHOWN ? `all ${entries.length} figures, with notes` : "notes"}
        </button>
      ) : null}
    </div>
  );
}
