import { useState } from "react";
import type { GalleryCard } from "../api/types";
import { formatFigure } from "../ui/format";
import { metricTitle, micro } from "../ui/metric-name";
import { Verdict } from "../ui/verdict";
import styles from "./gallery.module.css";

const SHOWN = 3;

interface ExpectationTableProps {
  entries: GalleryCard["expectations"];
  /** Of the whole; rows that differ from it say their own. */
  verdict: string | null;
}

/** Bounds as they are printed rather than typed. */
const typeset = (text: string) => text.replaceAll(">=", "≥").replaceAll("<=", "≤").replaceAll("-", "−");

/** Published, expected and measured, figure by figure; the first few until all are asked for. */
export function ExpectationTable({ entries, verdict }: ExpectationTableProps) {
  const [all, setAll] = useState(false);
  if (entries.length === 0) return <p className={styles.nothing}>Nothing is claimed: a bench to play with.</p>;
  const rows = all ? entries : entries.slice(0, SHOWN);
  return (
    <div className={styles.figures}>
      <table>
        <thead>
          <tr>
            <th scope="col">figure</th>
            <th scope="col">published</th>
            <th scope="col">expected</th>
            <th scope="col">measured</th>
          </tr>
        </thead>
        <tbody>
          {rows.map((entry) => (
            <tr key={entry.metric} title={micro(`${entry.metric}${entry.note ? `: ${entry.note}` : ""}`)}>
              <th scope="row">
                {metricTitle(entry.metric)}
                {entry.verdict !== verdict && (
                  <div>
                    <Verdict verdict={entry.verdict} borneOut={entry.ok === true} />
                  </div>
                )}
                {all && entry.note && <small>{micro(entry.note)}</small>}
              </th>
              <td>{micro(entry.published ?? "").replaceAll(" %", "\u00a0%") || "–"}</td>
              <td className={styles.expected}>{typeset(entry.expected)}</td>
              <td data-ok={entry.ok}>
                {formatFigure(entry.metric, entry.measured)}
                {entry.ok === false && " ✗"}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      {entries.length > SHOWN || entries.some((entry) => entry.note) ? (
        <button type="button" className={styles.more} aria-expanded={all} onClick={() => setAll(!all)}>
          {all ? "less" : entries.length > SHOWN ? `all ${entries.length} figures, with notes` : "notes"}
        </button>
      ) : null}
    </div>
  );
}
