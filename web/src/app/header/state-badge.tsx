import { useBench } from "../../stream/bench-store";
import { useBoardState, useStaleSince } from "../../stream/freshness";
import styles from "./header.module.css";

const WORDS = { running: "running", paused: "paused", tripped: "tripped" } as const;

/** What the board does right now, or that we do not know. */
export function StateBadge() {
  const shown = useBoardState();
  const phase = useBench((s) => s.connection.phase);
  const stale = useStaleSince() !== undefined;
  const word = shown
    ? WORDS[shown]
    : phase === "waiting"
      ? "reconnecting"
      : phase === "closed"
        ? "not connected"
        : stale
          ? "silent"
          : "connecting";
  return (
    <span className={styles.state} data-state={shown ?? "unknown"} data-testid="bench-state">
      <i aria-hidden="true" />
      {word}
    </span>
  );
}
