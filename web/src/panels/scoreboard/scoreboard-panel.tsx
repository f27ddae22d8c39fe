import { useMemo } from "react";
import { diagnoserWords, hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { Confusion } from "../../ui/confusion";
import { EmptyState } from "../../ui/empty-state";
import { formatNumber, formatPercent, formatSi } from "../../ui/format";
import { TableHead } from "../../ui/table-head";
import { meanDelay } from "../lanes/delays";
import { FalseSwitches } from "../lanes/false-switches";
import { START_UP } from "../lanes/lanes-headline";
import styles from "./scoreboard.module.css";
import { WeightedTable } from "./weighted-table";

/** Each diagnoser against the truth the bench knows. */
export function ScoreboardPanel() {
  const scores = useBench((s) => s.scores);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const unlabelled = useBench((s) => s.bench?.record?.labels.length === 0);
  const entries = Object.entries(scores);
  const ids = useMemo(() => Object.keys(diagnosers ?? {}), [diagnosers]);
  if (unlabelled)
    return (
      <EmptyState title="No score">
        The record has no labels, so the truth is not known: there are verdicts, and nothing to score them by.
      </EmptyState>
    );
  if (entries.length === 0)
    return (
      <EmptyState title="No score">
        {Object.keys(diagnosers ?? {}).length > 0
          ? "Each diagnoser is scored from its first sample on; none has judged a sample yet."
          : "This bench has no diagnoser. The panel Diagnosis adds one."}
      </EmptyState>
    );
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a region that scrolls is reached by the keyboard
    <section className="view-page" aria-label="Scoreboard" tabIndex={0}>
      <table className={styles.table}>
        <TableHead names={["Diagnoser", "Correct", "Mean delay", "Not found", "False switches"]} />
        <tbody>
          {entries.map(([id, score]) => {
            const missed = score.delays.filter((d) => d === null).length;
            const mean = meanDelay(score.delays);
            const [startUp] = score.delays;
            return (
              <tr key={id}>
                <th scope="row">{diagnoserWords(id, diagnosers)}</th>
                <td>{formatPercent(score.correct_fraction, 2)}</td>
                <td>
                  {mean === undefined ? "–" : formatNumber(mean, 1)}
                  {mean !== undefined && <small>samples, {formatSi(mean * dtMs, "ms", 3)}</small>}
                  {startUp && <small title={START_UP}>start-up {formatSi(startUp * dtMs, "ms", 3)}</small>}
                </td>
                <td>
                  {missed} of {score.delays.length}
                </td>
                <td>
                  <FalseSwitches score={score} />
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
      <WeightedTable ids={ids} />
      {entries.map(
        ([id, score]) =>
          score.confusion && (
            <Confusion
              key={id}
              title={diagnoserWords(id, diagnosers)}
              names={(score.names ?? diagnosers?.[id]?.names ?? []).map((name) => hypothesisWords(name, diagnosers))}
              counts={score.confusion}
            />
          ),
      )}
    </section>
  );
}
