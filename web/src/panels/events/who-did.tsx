import { classes } from "../../api/classes";
import { useAnswer } from "../../api/queries";
import { EmptyState } from "../../ui/empty-state";
import { formatTick } from "../../ui/format";
import { Stale } from "../../ui/stale";
import styles from "./events.module.css";

const EVERY_MS = 3000;

/** Actions of users on a bench, drivers and arrivals, newest first; the list outlives the bench. */
export function WhoDid({ bench }: { bench: string }) {
  const { value, error, since, again } = useAnswer(
    ["bench-audit", bench],
    () => classes.benchAudit(bench),
    () => EVERY_MS,
  );
  return (
    <>
      <Stale error={error} since={since} onRetry={again} />
      {value?.length === 0 && <EmptyState title="Nothing yet">Actions on this bench are listed here.</EmptyState>}
      <ol className={styles.list} aria-label="Who did what, newest first">
        {value?.map(({ at, actor, text, tick }) => (
          <li key={`${at} ${actor} ${text}`} className={styles.did}>
            <time className="note" dateTime={at}>
              {new Date(at).toLocaleTimeString()}
            </time>
            <span className={styles.text}>
              <b>{actor}</b>: {text}
            </span>
            <small>{tick !== null && formatTick(tick)}</small>
          </li>
        ))}
      </ol>
    </>
  );
}
