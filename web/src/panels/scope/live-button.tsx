import { useLayoutEffect, useRef } from "react";
import { useBench } from "../../stream/bench-store";
import { staleWords, useBoardState, useStaleSince } from "../../stream/freshness";
import styles from "./scope.module.css";

/** Says that a picture follows the board; in the past it is a button that leads back to now and leaves the focus here. */
export function LiveButton({ past, onLive }: { past: boolean; onLive(): void }) {
  const running = useBoardState() === "running";
  const stale = useStaleSince();
  const isPast = useBench((s) => Boolean(s.bench?.origin?.is_past));
  const label = useRef<HTMLSpanElement>(null);
  const isPressed = useRef(false);
  useLayoutEffect(() => {
    if (!past && isPressed.current) label.current?.focus();
    isPressed.current = false;
  }, [past]);
  if (past)
    return (
      <button
        type="button"
        className={styles.live}
        title="Return to the newest data"
        onClick={() => {
          isPressed.current = true;
          onLive();
        }}
      >
        PAST → LIVE
      </button>
    );
  return (
    <span
      ref={label}
      tabIndex={-1}
      className={styles.live}
      data-running={running}
      data-stale={stale !== undefined}
      title="Drag or scroll the plot to look at the past; the board runs on"
    >
      {isPast ? "AS IT WAS" : stale ? staleWords(stale) : running ? "LIVE" : "PAUSED"}
    </span>
  );
}
