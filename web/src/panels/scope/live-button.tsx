import { useBench } from "../../stream/bench-store";
import { staleWords, useBoardState, useStaleSince } from "../../stream/freshness";
import styles from "./scope.module.css";

/** Says whether a picture follows the board, and leads back to now from the past. */
export function LiveButton({ past, onLive }: { past: boolean; onLive(): void }) {
  const running = useBoardState() === "running";
  const stale = useStaleSince();
  const isPast = useBench((s) => Boolean(s.bench?.origin?.is_past));
  return (
    <button
      type="button"
      className={styles.live}
      data-past={past}
      data-running={running}
      data-stale={stale !== undefined}
      aria-pressed={!past}
      onClick={onLive}
      title={past ? "Return to the newest data" : "Drag or scroll the plot to look at the past; the board runs on"}
    >
      {past ? "PAST → LIVE" : isPast ? "AS IT WAS" : stale ? staleWords(stale) : running ? "LIVE" : "PAUSED"}
    </button>
  );
}
