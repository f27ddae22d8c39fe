import { classes } from "../../api/classes";
import { useAnswer } from "../../api/queries";
import { EmptyState } from "../../ui/empty-state";
import { formatTick } from "../../ui/format";
import { Stale } from "../../ui/stale";
import styles from "./events.module.css";

const EVERY_MS = 3000;

/** Who did what to a bench, who drove it and who came, newest first; it is kept when the bench goes. */
export function WhoDid({ bench }: { bench: string }) {
  const { value, error, since, again } = useAnswer(
    ["bench-audit", bench],
    () => classes.benchAudit(bench),
    () => EVERY_MS,
  );
  return (
    <>
      <Stale error={error} since={since} onRetry={again} />
      {value?.length === 0 && <EmptyState title="Nothing yet">Who does something here will be listed.</EmptyState>}
      <ol className={styles.list} aria-label="Who did what, newest first">
        {value?.map(({ at, actor, text, tick }) => (
          <li key={`${at} ${actor} ${text}`} className={styles.did}>
            <time dateTime={at}>{new Date(at).toLocaleTimeString()}</time>
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
