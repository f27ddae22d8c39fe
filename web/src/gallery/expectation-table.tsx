import { useState } from "react";
import type { GalleryCard } from "../api/types";
import { formatShort, keepUnits } from "../ui/format";
import { metricScale } from "../ui/metric-name";
import { TableHead } from "../ui/table-head";
import { Verdict } from "../ui/verdict";
import styles from "./gallery.module.css";

const SHOWN = 3;
const MORE = { marginTop: 4, padding: "2px 0", color: "var(--accent)", font: "560 var(--size-0) var(--font)" };

type Expected = GalleryCard["expectations"][number];
/** A row; runs of earlier versions lack the newer fields. */
type Entry = Omit<Expected, "fitted" | "reason" | "comparator" | "pid_too" | "expected_words"> & Partial<Expected>;

interface ExpectationTableProps {
  entries: Entry[];
  /** Of the whole; rows that differ from it say their own. */
  verdict: string | null;
}

/** The remarks on a figure: its note, the values chosen for it, and why it has no open loop. */
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

/** For each figure the expected and the measured value, and the value of the open loop; the first few, or all on request. */
export function ExpectationTable({ entries, verdict }: ExpectationTableProps) {
  const [all, setAll] = useState(false);
  if (entries.length === 0)
    return (
      <p className="note" style={{ flex: 1 }}>
        This experiment makes no claim.
      </p>
    );
  const rows = all ? entries : entries.slice(0, SHOWN);
  const hasOpenLoop = entries.some((entry) => typeof entry.open_loop === "number");
  const hasPid = entries.some((entry) => typeof entry.pid === "number");
  return (
    <div className={styles.figures}>
      <table>
        <TableHead
          names={[
            "figure",
            "expected",
            "measured",
            hasOpenLoop && ["open loop", "The same scenario with the open loop in place of its controller"],
            hasPid && ["PID", "The same scenario with a tuned PID in place of its controller"],
          ]}
        />
        <tbody>
          {rows.map((entry) => {
            const { name, say } = metricScale(entry.metric, []);
            const expected = entry.expected_words ?? readable(entry);
            return (
              <tr key={entry.metric} title={[entry.metric, ...remarks(entry)].join(": ")}>
                <th scope="row">
                  {name}
                  {entry.published && <small>published: {entry.published.replaceAll(" %", "\u00a0%")}</small>}
                  {entry.comparator && (
                    <small>
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
                <td style={{ fontWeight: 620, color: entry.ok === false ? "var(--alarm)" : undefined }}>
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
        <button type="button" style={MORE} aria-expanded={all} onClick={() => setAll(!all)}>
          {all ? "less" : entries.length > SHOWN ? `all ${entries.length} figures, with notes` : "notes"}
        </button>
      ) : null}
    </div>
  );
}
